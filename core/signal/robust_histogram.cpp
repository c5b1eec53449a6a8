#include "core/signal/robust_histogram.hpp"

#include "core/signal/median.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace driftlab {
namespace {

constexpr double kReach = 8.0;

double below(double z) { return 0.5 * std::erfc(-z / std::numbers::sqrt2); }

}  // namespace

std::optional<RobustHistogram> robust_histogram(std::span<const double> values, std::size_t bins) {
  if (values.empty()) {
    return std::nullopt;
  }
  std::vector<double> work(values.begin(), values.end());
  RobustHistogram result;
  result.median = take_median(work);
  for (double& value : work) {
    value = std::abs(value - result.median);
  }
  result.sigma = kGaussianOfMedian * take_median(work);
  if (result.sigma <= 0.0) {
    return std::nullopt;
  }
  const double width = 2.0 * kReach / static_cast<double>(bins);
  for (std::size_t i = 0; i <= bins; ++i) {
    result.edges.push_back(-kReach + width * static_cast<double>(i));
  }
  result.counts.assign(bins, 0);
  for (const double value : values) {
    const double place = ((value - result.median) / result.sigma + kReach) / width;
    if (place < 0.0) {
      ++result.below;
    } else if (place >= static_cast<double>(bins)) {
      ++result.above;
    } else {
      ++result.counts[static_cast<std::size_t>(place)];
    }
  }
  for (std::size_t i = 0; i < bins; ++i) {
    result.gaussian.push_back(static_cast<double>(values.size()) *
                              (below(result.edges[i + 1]) - below(result.edges[i])));
  }
  return result;
}

}  // namespace driftlab
