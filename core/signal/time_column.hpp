#pragma once
/// The time column of a recording, put in order as far as that needs no guess. Internal to core/signal.
#include "core/signal/result.hpp"
#include "core/signal/unit.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace driftlab {

/// Time stamps [s] of every row, and what was found in them.
struct TimeColumn {
  std::vector<double> stamps;         ///< counter wraps continued; falling only at `backward`
  std::size_t wraps = 0;              ///< times a counter started again at 0
  std::vector<std::size_t> backward;  ///< rows whose stamp lies before that of the row above: the clock was set back
  double largest_step_back_s = 0.0;
  [[nodiscard]] double advanced_s() const;  ///< sum of the steps forward
};

/// Reads the time column. A counter of 16 or 32 bits (of ticks, or scaled to seconds from ms or us) that starts again
/// is continued, provided that the step across the wrap is at most 5 median steps. Any other step back splits the
/// recording there. If one row in a thousand or more has such a step, the column is no clock and is refused. Errors:
/// NonFinite (a stamp is missing), NonMonotonicTime; both name the row. O(rows) time and memory.
[[nodiscard]] Result<TimeColumn> read_time_column(std::span<const double> column, const Unit& unit);

}  // namespace driftlab
