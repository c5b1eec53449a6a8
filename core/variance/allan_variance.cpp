#include "core/variance/allan_variance.hpp"

#include "core/variance/kernels.hpp"
#include "core/variance/prefix_sums.hpp"

#include <algorithm>
#include <cmath>

namespace driftlab {

std::vector<double> allan_variance(std::span<const double> samples, double pivot, std::span<const std::size_t> m,
                                   const RunControl& control) {
  const auto power = [](const double* now, std::size_t half, std::size_t count) {
    double sum = 0.0;
    kernels().octave_powers(now, half, 1, count, &sum);
    return sum;
  };
  std::vector<double> sum = filter_powers(samples, pivot, m, 2, power, control);
  const std::size_t n = samples.size();
  for (std::size_t k = 0; k < sum.size(); ++k) {
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
