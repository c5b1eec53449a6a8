#include "core/variance/prefix_sums.hpp"

#include <algorithm>
#include <array>

namespace driftlab {

void extend_prefix(std::span<const double> block, double pivot, double& base, double& carry, double* out) {
  // Four quarters run at once: a single running sum would wait for its own last addition.
  const double* const samples = block.data();
  const std::size_t count = block.size();
  const std::size_t quarter = count / 4;
  std::array<double, 4> inside{};
  for (std::size_t i = 0; i < quarter; ++i) {
    for (std::size_t q = 0; q < 4; ++q) {
      inside[q] += samples[q * quarter + i] - pivot;
      out[q * quarter + i] = inside[q];
    }
  }
  for (std::size_t i = 4 * quarter; i < count; ++i) {
    inside[3] += samples[i] - pivot;
    out[i] = inside[3];
  }
  for (std::size_t q = 0; q < 4; ++q) {
    const std::size_t end = q == 3 ? count : (q + 1) * quarter;
    for (std::size_t i = q * quarter; i < end; ++i) {
      out[i] = base + (out[i] + carry);
    }
    const double next = base + (inside[q] + carry);
    carry = (inside[q] + carry) - (next - base);
    base = next;
  }
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
