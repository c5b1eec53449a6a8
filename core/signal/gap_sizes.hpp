#pragma once
/// How many samples a jump of the time column lacks. Internal to core/signal.
#include "core/signal/gappy_samples.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace driftlab {

/// `stamps` are the time stamps [s] of all rows, `jumps` the rows (ascending) before which the step is too long, and
/// `interval_s` the mean sample interval. Each row is placed on the grid of that interval: one place after the row
/// before it, plus the missing places. The number missing at a jump follows from the medians of stamp minus place over
/// up to 32 rows on either side. Rounding of single stamps, bursts, and a late stamp that the next ones make up for
/// therefore do not count. Jumps within 32 rows of each other are settled together: first each by the rows up to the
/// next, then each by all 32 with what is missing at the others, until nothing changes. Jumps at which nothing is
/// missing are left out. The stamps start anew at the rows `backward` (ascending), and no median extends across one.
/// O(64 jumps).
[[nodiscard]] std::vector<Gap> gap_sizes(std::span<const double> stamps, std::span<const std::size_t> jumps,
                                         std::span<const std::size_t> backward, double interval_s);

}  // namespace driftlab
