#pragma once
/// The stretches of a recording in which a triad was held still.
#include "core/calibrate/triad.hpp"

#include <cstddef>
#include <vector>

namespace driftlab {

struct StillInterval {
  std::size_t first = 0;
  std::size_t count = 0;
};

struct StillOptions {
  double block_s = 0.25;    ///< samples are judged in blocks of this length
  double shortest_s = 1.0;  ///< intervals below this are dropped
  double factor = 10.0;     ///< a block is still if its variance is at most this many times that of the stillest ones
  double margin_s = 0.25;   ///< left out at both ends of an interval
};

/// Finds the still intervals from blocks. The variance of a block is that of its three channels together. The level of
/// the stillest blocks is the 5 % quantile over all blocks, so at least some 5 % of the recording has to be still.
/// Adjacent still blocks form one interval as long as their means agree within 6 standard deviations (of a block's
/// mean, from the stillest blocks), so that two positions stay apart even if no motion was seen between them. After
/// Tedaldi, Pretto and Menegatti (ICRA 2014), section V, who take the threshold from a still start. Errors:
/// ShapeMismatch, InvalidArgument (rate or options not positive), TooFewSamples (below 20 blocks). O(n).
[[nodiscard]] Result<std::vector<StillInterval>> find_still_intervals(
    const std::array<std::span<const double>, 3>& channels, double rate_hz, const StillOptions& options = {});

}  // namespace driftlab
