#pragma once
/// What trims leave of a recording with even steps.
#include "core/signal/recording.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace driftlab {

struct KeptRows {
  std::size_t first = 0;
  std::size_t end = 0;  ///< behind the last; not above `first` where nothing is left

  [[nodiscard]] std::size_t count() const { return end > first ? end - first : 0; }
};

/// Rows [first, end) of `rows` rows `dt_s` [s] apart. A sample at exactly the trim stays; a slack of a millionth of a
/// step absorbs the rounding of seconds over steps. A negative trim counts as 0.
[[nodiscard]] inline KeptRows kept_rows(const Trim& trim, double dt_s, std::size_t rows) {
  const auto rows_in = [&](double seconds) {
    constexpr double kSlack = 1e-6;
    return static_cast<std::size_t>(std::clamp(std::ceil(seconds / dt_s - kSlack), 0.0, static_cast<double>(rows)));
  };
  return {rows_in(trim.start_s), rows - rows_in(trim.end_s)};
}

}  // namespace driftlab
