#include "core/signal/robust_histogram.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace driftlab {
namespace {

constexpr double kReach = 8.0;
/// One over the 75 % point of the standard Gaussian distribution.
constexpr double kGaussianWidth = 1.482602218505602;

double median_of(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

double below(double z) { return 0.5 * std::erfc(-z / std::numbers::sqrt2); }

}  // namespace

std::optional<RobustHistogram> robust_histogram(std::span<const double> values, std::size_t bins) {
  if (values.empty()) {
    return std::nullopt;
  }
  std::vector<double> work(values.begin(), values.end());
  RobustHistogram result;
  result.median = median_of(work);
  for (double& value : work) {
    value = std::abs(value - result.median);
  }
  result.sigma = kGaussianWidth * median_of(work);
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
