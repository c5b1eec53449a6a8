#include "core/investigate/slow/block_series.hpp"

#include <algorithm>
#include <cmath>

namespace driftlab::investigate {

std::size_t BlockSeries::blocks() const {
  std::size_t sum = 0;
  for (const BlockRecording& recording : recordings) {
    sum += recording.mean.size();
  }
  return sum;
}

double BlockSeries::longest_s() const {
  std::size_t longest = 0;
  for (const BlockRecording& recording : recordings) {
    longest = std::max(longest, recording.mean.size());
  }
  return block_s() * static_cast<double>(longest);
}

BlockSeries average_blocks(const ChannelGroup& group, const std::vector<std::vector<unsigned char>>& mask,
                           bool full_rate) {
  // Blocks of about a fifth of a second; what is faster is left to the full rate. Chosen, not measured.
  constexpr double kBlockRateHz = 5.0;
  BlockSeries series;
  series.dt_s = group.members.front().recording->dt_s;
  series.block =
      full_rate ? 1
                : std::max<std::size_t>(1, static_cast<std::size_t>(std::lround(1.0 / (kBlockRateHz * series.dt_s))));
  for (std::size_t r = 0; r < group.members.size(); ++r) {
    const StudyRecording& recording = *group.members[r].recording;
    const Channel& channel = *group.members[r].channel;
    BlockRecording blocks;
    blocks.first = recording.begin;
    blocks.start_s = recording.time_s(recording.begin);
    const std::size_t count = recording.count() / series.block;
    const double noise = 1.0 + noise_of_reference(group.members[r]);
    blocks.mean.resize(count, 0.0);
    blocks.filled.resize(count, 0.0);
    for (std::size_t b = 0; b < count; ++b) {
      double sum = 0.0;
      std::size_t valid = 0;
      const std::size_t from = recording.begin + b * series.block;
      for (std::size_t i = from; i < from + series.block; ++i) {
        if (channel.valid[i] != 0 && (r >= mask.size() || mask[r].empty() || mask[r][i] == 0)) {
          sum += channel.error[i];
          ++valid;
        }
      }
      const double filled = static_cast<double>(valid) / static_cast<double>(series.block);
      if (filled >= 0.25) {
        blocks.mean[b] = sum / static_cast<double>(valid);
        blocks.filled[b] = filled / noise;
      }
    }
    blocks.pattern = series.recordings.size();
    for (const BlockRecording& other : series.recordings) {
      if (other.filled == blocks.filled && other.start_s == blocks.start_s) {
        blocks.pattern = other.pattern;
        break;
      }
    }
    series.recordings.push_back(std::move(blocks));
  }
  return series;
}

std::vector<double> average_like(const BlockSeries& series, std::size_t r, std::span<const double> grid) {
  const BlockRecording& blocks = series.recordings[r];
  std::vector<double> mean(blocks.mean.size());
  for (std::size_t b = 0; b < mean.size(); ++b) {
    double sum = 0.0;
    const std::size_t from = blocks.first + b * series.block;
    for (std::size_t i = from; i < from + series.block; ++i) {
      sum += grid[i];
    }
    mean[b] = sum / static_cast<double>(series.block);
  }
  return mean;
}

}  // namespace driftlab::investigate
