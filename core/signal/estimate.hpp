#pragma once
/// A number with its interval, the form in which every estimate travels.
#include <limits>
#include <optional>

namespace driftlab {

/// A two-sided confidence interval. An open end is infinite and means: the data do not bound the quantity there.
struct Interval {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  [[nodiscard]] bool contains(double value) const { return low <= value && value <= high; }
  /// Infinite where an end is open.
  [[nodiscard]] double half_width() const { return 0.5 * (high - low); }
};

/// A point estimate with its 95 % interval, both in SI.
struct Estimate {
  double value = 0.0;
  Interval ci95;
};

}  // namespace driftlab
