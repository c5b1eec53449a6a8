#pragma once
/// How many samples a jump of the time column lacks. Internal to core/signal.
#include "core/signal/gappy_samples.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace driftlab {

/// `stamps` [s] of every row, rows `jumps` (rising) before which the step is too long, `interval_s` the mean interval
/// of a sample. Each row is laid on the grid of that interval, one place after the row before it plus what is missing.
/// At a jump, the medians of stamp minus place over up to 32 rows on either side say by how many places the rows behind
/// it lie later: the rounding of single stamps, bursts and a late stamp made up for by the next ones do not count.
/// Jumps that lack nothing are left out. Rows `backward` (rising) start anew: no median looks across one. O(64 jumps).
[[nodiscard]] std::vector<Gap> gap_sizes(std::span<const double> stamps, std::span<const std::size_t> jumps,
                                         std::span<const std::size_t> backward, double interval_s);

}  // namespace driftlab
