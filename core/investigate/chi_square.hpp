#pragma once
/// Normal and chi-square tails by the cube root of Wilson and Hilferty (1931): good to a few percent of p down to 1e-6.
#include <algorithm>
#include <cmath>

namespace driftlab::investigate {

[[nodiscard]] inline double normal_tail(double z) { return 0.5 * std::erfc(z / std::sqrt(2.0)); }

[[nodiscard]] inline double chi_square_tail(double x, double dof) {
  const double v = 2.0 / (9.0 * dof);
  return normal_tail((std::cbrt(x / dof) - (1.0 - v)) / std::sqrt(v));
}

/// At `z` standard deviations of a normal variable: -1.96, 0 and 1.96 give the 2.5 %, 50 % and 97.5 % quantiles.
[[nodiscard]] inline double chi_square_quantile(double z, double dof) {
  const double v = 2.0 / (9.0 * dof);
  const double root = std::max(0.0, 1.0 - v + z * std::sqrt(v));
  return dof * root * root * root;
}

}  // namespace driftlab::investigate
