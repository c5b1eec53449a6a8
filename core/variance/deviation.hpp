#pragma once
/// Deviations of variances, with their intervals.
///
/// The root is monotone, so the ends of an interval of the variance are those of the deviation. An interval of a
/// variance may reach below 0, where an estimate scatters about little; a deviation does not.
#include "core/signal/estimate.hpp"

#include <algorithm>
#include <cmath>

namespace driftlab {

/// [unit] of a variance [unit^2]; NaN below 0, which no estimate is.
[[nodiscard]] inline double deviation_of(double variance) { return std::sqrt(variance); }

/// The ends of the interval, those below 0 as 0.
[[nodiscard]] inline Interval deviation_of(const Interval& variance) {
  return {std::sqrt(std::max(variance.low, 0.0)), std::sqrt(std::max(variance.high, 0.0))};
}

}  // namespace driftlab
