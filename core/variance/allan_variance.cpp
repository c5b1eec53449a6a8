#include "core/variance/allan_variance.hpp"

#include "core/variance/kernels.hpp"
#include "core/variance/prefix_sums.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <memory>

namespace driftlab {

std::vector<double> allan_variance(std::span<const double> samples, double pivot, std::span<const std::size_t> m,
                                   const RunControl& control) {
  const std::unique_ptr<double[]> prefix = prefix_sums(samples, pivot);
  const std::size_t n = samples.size();
  std::vector<double> sum(m.size(), 0.0);
  // Block by block, so that the block of the newest prefix sums stays in cache for all half lengths.
  constexpr std::size_t kBlock = 4096;
  for (std::size_t start = 1; start <= n; start += kBlock) {
    if (control.stop.stop_requested()) {
      return {};
    }
    const std::size_t end = std::min(n + 1, start + kBlock);
    for (std::size_t k = 0; k < m.size(); ++k) {
      assert(m[k] > 0 && 2 * m[k] <= n);
      const std::size_t first = std::max(start, 2 * m[k]);
      if (first < end) {
        kernels().octave_powers(prefix.get() + first, m[k], 1, end - first, &sum[k]);
      }
    }
  }
  for (std::size_t k = 0; k < m.size(); ++k) {
    const auto half = static_cast<double>(m[k]);
    sum[k] /= 2.0 * half * half * static_cast<double>(n - 2 * m[k] + 1);
  }
  return sum;
}

std::vector<std::size_t> log_spaced_half_lengths(std::size_t samples, std::size_t count) {
  std::vector<std::size_t> m;
  if (samples < 2 || count == 0) {
    return m;
  }
  const double top = std::log(static_cast<double>(samples) / 2.0);
  for (std::size_t k = 0; k < count; ++k) {
    const double fraction = count > 1 ? static_cast<double>(k) / static_cast<double>(count - 1) : 0.0;
    const auto half = static_cast<std::size_t>(std::lround(std::exp(top * fraction)));
    const std::size_t bounded = std::clamp<std::size_t>(half, 1, samples / 2);
    if (m.empty() || bounded > m.back()) {
      m.push_back(bounded);
    }
  }
  return m;
}

}  // namespace driftlab
