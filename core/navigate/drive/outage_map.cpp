#include "core/navigate/drive/outage_map.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace driftlab::drive {

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

}  // namespace driftlab::drive
