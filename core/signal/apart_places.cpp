#include "core/signal/apart_places.hpp"

#include "core/signal/median.hpp"

#include <algorithm>
#include <cmath>

namespace driftlab {
namespace {

constexpr std::size_t kApartBlock = 64;
constexpr double kApartDeviations = 8.0;

/// Of each kApartBlock values in a row.
std::vector<double> block_medians(std::span<const double> values) {
  std::vector<double> medians;
  std::vector<double> block;
  for (std::size_t first = 0; first < values.size(); first += kApartBlock) {
    const std::span<const double> here = values.subspan(first, std::min(kApartBlock, values.size() - first));
    block.assign(here.begin(), here.end());
    medians.push_back(take_median(block));
  }
  return medians;
}

/// Robust standard deviation of values around the medians of their blocks.
double deviation_from(const std::vector<double>& medians, std::span<const double> values) {
  std::vector<double> distances(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    distances[i] = std::fabs(values[i] - medians[i / kApartBlock]);
  }
  return distances.empty() ? 0.0 : kGaussianOfMedian * take_median(distances);
}

/// Of a value of that block from the nearest of three medians: its own, and those before and behind.
double distance_from(const std::vector<double>& medians, std::size_t block, double value) {
  double least = std::fabs(value - medians[block]);
  if (block > 0) {
    least = std::min(least, std::fabs(value - medians[block - 1]));
  }
  if (block + 1 < medians.size()) {
    least = std::min(least, std::fabs(value - medians[block + 1]));
  }
  return least;
}

}  // namespace

std::vector<ApartPlace> apart_places(std::span<const double> values, double first_s, double dt_s) {
  constexpr double kTogether = 1.0;  // [s]
  const std::vector<double> medians = block_medians(values);
  const double deviation = deviation_from(medians, values);
  std::vector<ApartPlace> places;
  for (std::size_t i = 0; i < values.size() && deviation > 0.0; ++i) {
    const double deviations = distance_from(medians, i / kApartBlock, values[i]) / deviation;
    if (deviations <= kApartDeviations) {
      continue;
    }
    const double begins = first_s + dt_s * static_cast<double>(i);
    if (places.empty() || begins - places.back().t1_s > kTogether) {
      places.push_back({.t0_s = begins});
    }
    ApartPlace& place = places.back();
    place.t1_s = begins + dt_s;
    ++place.samples;
    place.deviations = std::max(place.deviations, deviations);
  }
  if (places.size() > kMostApart) {
    std::nth_element(places.begin(), places.begin() + kMostApart, places.end(),
                     [](const ApartPlace& a, const ApartPlace& b) { return a.deviations > b.deviations; });
    places.resize(kMostApart);
    std::sort(places.begin(), places.end(), [](const ApartPlace& a, const ApartPlace& b) { return a.t0_s < b.t0_s; });
  }
  return places;
}

}  // namespace driftlab
