#include "core/variance/hadamard_variance.hpp"

#include "core/process/haar_differences.hpp"
#include "core/variance/kernels.hpp"
#include "core/variance/prefix_sums.hpp"

#include <cmath>

namespace driftlab {

std::vector<double> hadamard_variance(std::span<const double> samples, double pivot, std::span<const std::size_t> m,
                                      const RunControl& control) {
  std::vector<double> sum = filter_powers(samples, pivot, m, 3, kernels().third_difference_power, control);
  const std::size_t n = samples.size();
  for (std::size_t k = 0; k < sum.size(); ++k) {
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
