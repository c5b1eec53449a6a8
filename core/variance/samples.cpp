#include "core/variance/samples.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>

namespace driftlab {
namespace {

constexpr std::size_t kLanes = 8;
constexpr std::size_t kBlock = 4096;
constexpr std::size_t kPollBlocks = 256;

tl::unexpected<Error> reject(std::span<const double> samples) {
  const auto bad =
      std::find_if(samples.begin(), samples.end(), [](double value) { return !(std::fabs(value) <= kLargestSample); });
  const std::string row = std::to_string(bad - samples.begin() + 1);
  if (std::isfinite(*bad)) {
    return fail(ErrorCode::OutOfRange, "The sample in row " + row + " is too large for its square to be formed.",
                {{"row", row}});
  }
  return fail(ErrorCode::NonFinite, "The sample in row " + row + " is not a finite number.", {{"row", row}});
}

}  // namespace

Result<SampleSummary> summarise(std::span<const double> samples, const RunControl& control) {
  if (samples.empty()) {
    return fail(ErrorCode::TooFewSamples, "There are no samples.");
  }
  const double pivot = samples.front();
  double total = 0.0;
  double carry = 0.0;
  std::array<double, kLanes> low{};
  std::array<double, kLanes> high{};
  low.fill(pivot);
  high.fill(pivot);
  bool sound = std::fabs(pivot) <= kLargestSample;
  for (std::size_t start = 0; start < samples.size(); start += kBlock) {
    if (start / kBlock % kPollBlocks == 0 && control.stop.stop_requested()) {
      return fail(ErrorCode::Cancelled, "The computation was cancelled.");
    }
    const std::size_t count = std::min(kBlock, samples.size() - start);
    const double* block = samples.data() + start;
    std::array<double, kLanes> sum{};
    std::size_t i = 0;
    for (; i + kLanes <= count; i += kLanes) {
      for (std::size_t k = 0; k < kLanes; ++k) {
        const double value = block[i + k];
        low[k] = value < low[k] ? value : low[k];
        high[k] = value > high[k] ? value : high[k];
        sum[k] += value - pivot;
      }
    }
    double block_sum = 0.0;
    for (const double part : sum) {
      block_sum += part;
    }
    for (; i < count; ++i) {
      low[0] = std::min(low[0], block[i]);
      high[0] = std::max(high[0], block[i]);
      block_sum += block[i] - pivot;
    }
    sound = sound && std::isfinite(block_sum);  // a NaN fails no comparison above, but it is in the sum
    const double y = block_sum - carry;
    const double next = total + y;
    carry = (next - total) - y;
    total = next;
  }
  SampleSummary summary;
  summary.minimum = *std::min_element(low.begin(), low.end());
  summary.maximum = *std::max_element(high.begin(), high.end());
  if (!sound || summary.minimum < -kLargestSample || summary.maximum > kLargestSample) {
    return reject(samples);
  }
  summary.mean = pivot + total / static_cast<double>(samples.size());
  return summary;
}

}  // namespace driftlab
