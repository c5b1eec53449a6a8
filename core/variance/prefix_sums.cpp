#include "core/variance/prefix_sums.hpp"

#include "core/variance/kernels.hpp"

#include <algorithm>
#include <cassert>

namespace driftlab {
namespace {

constexpr std::size_t kBlock = 4096;
constexpr std::size_t kPollBlocks = 256;

}  // namespace

void extend_prefix(std::span<const double> block, double pivot, double& base, double& carry, double* out) {
  const double inside = kernels().prefix_block(block.data(), block.size(), pivot, base, carry, out);
  const double next = base + inside;
  carry = inside - (next - base);
  base = next;
}

std::unique_ptr<double[]> prefix_sums(std::span<const double> samples, double pivot, const RunControl& control) {
  auto prefix = std::make_unique_for_overwrite<double[]>(samples.size() + 1);
  prefix[0] = 0.0;
  double base = 0.0;
  double carry = 0.0;
  for (std::size_t start = 0; start < samples.size(); start += kBlock) {
    if (start / kBlock % kPollBlocks == 0 && control.stop.stop_requested()) {
      return nullptr;
    }
    const std::size_t count = std::min(kBlock, samples.size() - start);
    extend_prefix(samples.subspan(start, count), pivot, base, carry, prefix.get() + start + 1);
  }
  return prefix;
}

std::vector<double> filter_powers(std::span<const double> samples, double pivot, std::span<const std::size_t> m,
                                  std::size_t spans, FilterPower power, const RunControl& control) {
  const std::unique_ptr<double[]> prefix = prefix_sums(samples, pivot, control);
  if (!prefix) {
    return {};
  }
  const std::size_t n = samples.size();
  std::vector<double> sum(m.size(), 0.0);
  for (std::size_t start = 1; start <= n; start += kBlock) {
    if (control.stop.stop_requested()) {
      return {};
    }
    const std::size_t end = std::min(n + 1, start + kBlock);
    for (std::size_t k = 0; k < m.size(); ++k) {
      assert(m[k] > 0 && spans * m[k] <= n);
      const std::size_t first = std::max(start, spans * m[k]);
      if (first < end) {
        sum[k] += power(prefix.get() + first, m[k], end - first);
      }
    }
  }
  return sum;
}

}  // namespace driftlab
