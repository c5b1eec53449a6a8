#pragma once
/// A channel group averaged over short blocks, which describes everything slow with a fraction of the samples.
///
/// Mean effects (drift, steps, scale factors, temperature, ...) and slow noise are below a few Hz. Averages over blocks
/// of L samples retain all information about them; the white part of a block has the variance N^2 / (samples dt).
#include "core/investigate/study/study.hpp"

#include <cstddef>
#include <vector>

namespace driftlab::investigate {

struct BlockRecording {
  double start_s = 0.0;      ///< time of the first block's first sample, from the first sample of the file
  std::size_t first = 0;     ///< grid place of that sample
  std::vector<double> mean;  ///< of the valid samples of each block [SI]
  /// Valid samples / L, 0 to 1; below 0.25 a block counts as empty (0). Samples beside a noisy reference count for
  /// less.
  std::vector<double> filled;
  std::size_t pattern = 0;  ///< recordings of equal pattern (filled, start_s) share their filter gains
};

struct BlockSeries {
  double dt_s = 0.0;      ///< sample interval
  std::size_t block = 1;  ///< L, samples per block
  std::vector<BlockRecording> recordings;

  [[nodiscard]] double block_s() const { return dt_s * static_cast<double>(block); }
  [[nodiscard]] std::size_t blocks() const;
  /// Length of the longest recording [s].
  [[nodiscard]] double longest_s() const;
};

/// Blocks of about 1/5 s; of single samples where `full_rate`. Recordings of another rate than the first get blocks of
/// equal duration. `mask[r]` (grid of recording r; may be empty) removes samples beside the invalid ones.
[[nodiscard]] BlockSeries average_blocks(const ChannelGroup& group, const std::vector<std::vector<unsigned char>>& mask,
                                         bool full_rate);

/// A series on the grid of member `r` averaged over the same blocks (all samples, valid or not, of a filled block).
[[nodiscard]] std::vector<double> average_like(const BlockSeries& series, std::size_t r, std::span<const double> grid);

}  // namespace driftlab::investigate
