#include "core/calibrate/still_intervals.hpp"

#include <algorithm>
#include <cmath>

namespace driftlab {
namespace {

struct Block {
  Triple mean{};
  double variance = 0.0;  ///< of the three channels together
};

Block look_at(const std::array<std::span<const double>, 3>& channels, std::size_t first, std::size_t count) {
  Block block;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::span<const double> values = channels[axis].subspan(first, count);
    double sum = 0.0;
    double square = 0.0;
    for (const double value : values) {
      const double centred = value - values.front();
      sum += centred;
      square += centred * centred;
    }
    const auto n = static_cast<double>(count);
    block.mean[axis] = values.front() + sum / n;
    block.variance += std::max(0.0, (square - sum * sum / n) / (n - 1.0));
  }
  return block;
}

}  // namespace

Result<std::vector<StillInterval>> find_still_intervals(const std::array<std::span<const double>, 3>& channels,
                                                        double rate_hz, const StillOptions& options) {
  if (channels[1].size() != channels[0].size() || channels[2].size() != channels[0].size()) {
    return fail(ErrorCode::ShapeMismatch, "The three channels of a triad have different numbers of samples.");
  }
  if (!(rate_hz > 0.0 && options.block_s > 0.0 && options.shortest_s > 0.0 && options.factor > 1.0 &&
        options.margin_s >= 0.0)) {
    return fail(ErrorCode::InvalidArgument, "The rate, the block and the shortest interval must be positive.",
                {{"parameter", "rate_hz"}});
  }
  const auto block = static_cast<std::size_t>(std::max(4.0, std::round(options.block_s * rate_hz)));
  const std::size_t blocks = channels[0].size() / block;
  if (blocks < 20) {
    return fail(ErrorCode::TooFewSamples, "The recording is too short to find in it where the sensor was still.");
  }
  std::vector<Block> seen;
  std::vector<double> variances;
  for (std::size_t i = 0; i < blocks; ++i) {
    seen.push_back(look_at(channels, i * block, block));
    variances.push_back(seen.back().variance);
  }
  const auto quiet = variances.begin() + static_cast<std::ptrdiff_t>(blocks / 20);
  std::nth_element(variances.begin(), quiet, variances.end());
  const double threshold = options.factor * *quiet;
  const double step = 6.0 * std::sqrt(*quiet / static_cast<double>(block));
  const auto margin = static_cast<std::size_t>(std::round(options.margin_s * rate_hz));
  const auto shortest = static_cast<std::size_t>(std::round(options.shortest_s * rate_hz));
  std::vector<StillInterval> intervals;
  const auto close = [&](std::size_t from, std::size_t to) {
    const std::size_t count = (to - from) * block;
    if (count >= shortest + 2 * margin) {
      intervals.push_back({from * block + margin, count - 2 * margin});
    }
  };
  std::size_t begin = 0;
  for (std::size_t i = 0; i < blocks; ++i) {
    const bool still = seen[i].variance <= threshold;
    bool joined = i > begin;
    for (std::size_t axis = 0; axis < 3 && joined; ++axis) {
      joined = std::abs(seen[i].mean[axis] - seen[i - 1].mean[axis]) <= std::max(step, 1e-3 * length(seen[i].mean));
    }
    if (!still || (i > begin && !joined)) {
      close(begin, i);
      begin = still ? i : i + 1;
    }
  }
  close(begin, blocks);
  return intervals;
}

}  // namespace driftlab
