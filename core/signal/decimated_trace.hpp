#pragma once
/// A recording as a screen can show it: least, greatest and mean value of every stretch of samples.
///
/// A stretch of one sample is that sample. What is missing (NaN) is left out; a stretch without any sample has no
/// values. Cost: one pass over the samples asked for.
#include <cstddef>
#include <span>
#include <vector>

namespace driftlab {

struct TraceBucket {
  std::size_t first = 0;  ///< first sample of the stretch, from the first of the series
  std::size_t present = 0;
  double low = 0.0;
  double high = 0.0;
  double mean = 0.0;
};

/// `samples` in at most `most` stretches of equal length, the last one perhaps shorter. `most` >= 1.
[[nodiscard]] std::vector<TraceBucket> decimated_trace(std::span<const double> samples, std::size_t most);

}  // namespace driftlab
