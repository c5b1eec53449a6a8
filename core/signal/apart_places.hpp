#pragma once
/// Where gross errors are in a series: values that stand apart from those around them.
///
/// A value is one that is more than eight robust standard deviations from the median of its 64 samples and from those
/// of the 64 before and behind: a drift or a jump of the level is none. The deviation is 1.4826 times the median
/// distance of all values from the medians of their 64.
#include <cstddef>
#include <span>
#include <vector>

namespace driftlab {

/// Values that stand apart, of which each is within 1 s of the one before.
struct ApartPlace {
  double t0_s = 0.0;        ///< since the first row of the file
  double t1_s = 0.0;        ///< where the last of them ends
  std::size_t samples = 0;  ///< of these values
  double deviations = 0.0;  ///< that the farthest of them is from the nearest of the three medians
};

/// So many places at most are told.
inline constexpr std::size_t kMostApart = 200;

/// By time; of more than kMostApart places those that are farthest out. Nothing where the deviation is zero. `first_s`
/// is the time of the first value. O(N) time, N doubles of memory.
[[nodiscard]] std::vector<ApartPlace> apart_places(std::span<const double> values, double first_s, double dt_s);

}  // namespace driftlab
