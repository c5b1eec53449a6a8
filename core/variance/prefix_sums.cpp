#include "core/variance/prefix_sums.hpp"

#include "core/variance/kernels.hpp"

#include <algorithm>

namespace driftlab {

void extend_prefix(std::span<const double> block, double pivot, double& base, double& carry, double* out) {
  const double inside = kernels().prefix_block(block.data(), block.size(), pivot, base, carry, out);
  const double next = base + inside;
  carry = inside - (next - base);
  base = next;
}

std::unique_ptr<double[]> prefix_sums(std::span<const double> samples, double pivot) {
  constexpr std::size_t kBlock = 4096;
  auto prefix = std::make_unique_for_overwrite<double[]>(samples.size() + 1);
  prefix[0] = 0.0;
  double base = 0.0;
  double carry = 0.0;
  for (std::size_t start = 0; start < samples.size(); start += kBlock) {
    const std::size_t count = std::min(kBlock, samples.size() - start);
    extend_prefix(samples.subspan(start, count), pivot, base, carry, prefix.get() + start + 1);
  }
  return prefix;
}

}  // namespace driftlab
