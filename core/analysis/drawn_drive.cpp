#include "core/analysis/drawn_drive.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace driftlab::drive {
namespace {

// nees_of_share of 50 and 95 %, to the digits that decide
constexpr double kNees50 = 1.3863;
constexpr double kNees95 = 5.9915;

}  // namespace

double nees_of_share(double share) { return -2.0 * std::log(1.0 - share); }

std::vector<MapPlace> ellipse95(const MapPlace& centre, const std::array<double, 3>& covariance_m2) {
  constexpr int kCorners = 32;
  const double radius = std::sqrt(nees_of_share(0.95));
  // Cholesky factor of the covariance in east and north.
  const double a = std::sqrt(std::max(covariance_m2[2], 0.0));
  const double b = a > 0.0 ? covariance_m2[1] / a : 0.0;
  const double c = std::sqrt(std::max(covariance_m2[0] - b * b, 0.0));
  std::vector<MapPlace> places;
  for (int k = 0; k <= kCorners; ++k) {
    const double angle = 2.0 * std::numbers::pi * k / kCorners;
    const double u = radius * std::cos(angle);
    const double v = radius * std::sin(angle);
    places.push_back({centre[0] + a * u, centre[1] + b * u + c * v});
  }
  return places;
}

double horizontal_m(double north_m, double east_m) { return std::hypot(north_m, east_m); }

EllipseClass ellipse_class(const std::optional<double>& nees) {
  if (!nees || !(*nees <= kNees95)) {
    return EllipseClass::Outside;
  }
  return *nees <= kNees50 ? EllipseClass::Within50 : EllipseClass::Within95;
}

MappedOutage mapped(const DriveOutage& outage, const Drive& drive) {
  const Vector3 place = drive.on_map(outage.reference_ecef_m);
  const Matrix3& covariance = outage.covariance_ned;
  return {.truth_m = {place.y(), place.x()},
          .error_m = {outage.error_ned_m.y(), outage.error_ned_m.x()},
          .covariance_m2 = {covariance(0, 0), covariance(0, 1), covariance(1, 1)},
          .nees = outage.nees()};
}

OutageMap map_of(std::span<const MappedOutage> outages) {
  OutageMap map;
  for (const MappedOutage& outage : outages) {
    const auto& [east, north] = outage.error_m;
    const MapPlace estimate{outage.truth_m[0] + east, outage.truth_m[1] + north};
    MapClass& among = map.classes[static_cast<std::size_t>(ellipse_class(outage.nees))];
    among.truths_m.push_back(outage.truth_m);
    among.strokes_m.push_back({outage.truth_m, estimate});
    among.strokes_m.push_back(ellipse95(estimate, outage.covariance_m2));
    map.largest_error_m = std::max(map.largest_error_m, horizontal_m(north, east));
  }
  return map;
}

std::vector<MapPlace> way_of(const Drive& drive) {
  constexpr std::size_t kMost = 500;
  const std::vector<ReferencePoint>& reference = drive.reference;
  const std::size_t step = reference.size() / kMost + 1;
  std::vector<MapPlace> way;
  for (std::size_t i = 0; i < reference.size(); i += step) {
    const bool last = i + step >= reference.size();
    const Vector3 place = drive.on_map((last ? reference.back() : reference[i]).position_ecef_m);
    way.push_back({place.y(), place.x()});
  }
  return way;
}

}  // namespace driftlab::drive
