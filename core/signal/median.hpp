#pragma once
/// The median of a list, and the standard deviation that a median distance stands for.
#include <algorithm>
#include <cstddef>
#include <vector>

namespace driftlab {

/// Standard deviations of Gaussian numbers in their median absolute deviation: one over the 75 % point of the standard
/// Gaussian distribution.
inline constexpr double kGaussianOfMedian = 1.4826022185056018;

/// Reorders the values; the upper one of two in the middle. Precondition: not empty. O(n).
[[nodiscard]] inline double take_median(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace driftlab
