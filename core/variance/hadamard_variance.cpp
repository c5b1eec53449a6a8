#include "core/variance/hadamard_variance.hpp"

#include "core/process/haar_differences.hpp"
#include "core/variance/kernels.hpp"
#include "core/variance/prefix_sums.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace driftlab {

std::vector<double> hadamard_variance(std::span<const double> samples, double pivot, std::span<const std::size_t> m,
                                      const RunControl& control) {
  const std::unique_ptr<double[]> prefix = prefix_sums(samples, pivot);
  const std::size_t n = samples.size();
  std::vector<double> sum(m.size(), 0.0);
  constexpr std::size_t kBlock = 4096;
  for (std::size_t start = 1; start <= n; start += kBlock) {
    if (control.stop.stop_requested()) {
      return {};
    }
    const std::size_t end = std::min(n + 1, start + kBlock);
    for (std::size_t k = 0; k < m.size(); ++k) {
      assert(m[k] > 0 && 3 * m[k] <= n);
      const std::size_t first = std::max(start, 3 * m[k]);
      if (first < end) {
        sum[k] += kernels().third_difference_power(prefix.get() + first, m[k], end - first);
      }
    }
  }
  for (std::size_t k = 0; k < m.size(); ++k) {
    const auto length = static_cast<double>(m[k]);
    sum[k] /= 6.0 * length * length * static_cast<double>(n - 3 * m[k] + 1);
  }
  return sum;
}

double hadamard_variance(const Model& model, double m, double dt_s) {
  double sum = 0.0;
  for (const Process& process : model) {
    const ProcessKind& kind = *process.kind;
    if (process.haar_mean(m, dt_s) != 0.0) {
      continue;  // a ramp
    }
    const double nu = process.haar_variance(m, dt_s);
    if (kind.symbol == "SIN") {  // its coefficients are declared without scatter; a line is filtered at one frequency
      const double s = scaled_phase(process.parameters[1] * dt_s, m).sine;
      sum += 8.0 / 3.0 * nu * s * s;
      continue;
    }
    const double lag = m;
    double gamma = 0.0;
    kind.add_haar_cross(process.parameters, m, m, dt_s, {&lag, 1}, 1.0, {&gamma, 1});
    sum += 4.0 / 3.0 * (nu - gamma);
  }
  return sum;
}

}  // namespace driftlab
