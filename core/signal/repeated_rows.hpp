#pragma once
/// Rows that a logger wrote twice. Internal to core/signal.
///
/// A row with the stamp and every value of the row above is a repetition of it, not a second sample. Two samples may
/// share a stamp by chance (a coarse clock) and, on a coarse lattice or from a frozen sensor, their values too. Rows
/// are therefore taken as repetitions only if at least half of those that repeat a stamp repeat everything, and if rows
/// whose stamp moves on repeat the values at most half as often.
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

namespace driftlab {

/// The rows (from 0, ascending) that repeat the row above. `column(i)` gives column i < columns of the file, the stamps
/// among them. O(rows) where no stamp repeats, else O(rows columns).
[[nodiscard]] std::vector<std::size_t> repeated_rows(std::span<const double> stamps, std::size_t columns,
                                                     const std::function<std::span<const double>(std::size_t)>& column);

}  // namespace driftlab
