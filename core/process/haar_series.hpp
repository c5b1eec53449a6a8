#pragma once
/// The hyperbolic functions behind the Haar wavelet variance of an exponential autocovariance e^-x|h|, without
/// cancellation for small arguments. x is real for a Gauss-Markov process and complex for a damped oscillation; the
/// formulas are the same.
#include <array>
#include <cmath>
#include <complex>
#include <cstddef>

namespace driftlab::haar_series {

/// (sinh x - x) / x^3 of s = x^2, |s| <= 1.
template <class Number>
[[nodiscard]] Number sinh_rest(const Number& s) {
  Number sum = 1.0;
  for (const double factor : {1.0 / 210.0, 1.0 / 156.0, 1.0 / 110.0, 1.0 / 72.0, 1.0 / 42.0, 1.0 / 20.0}) {
    sum = 1.0 + s * factor * sum;
  }
  return sum * (1.0 / 6.0);
}

/// sinh x - x.
template <class Number>
[[nodiscard]] Number sinh_minus(const Number& x) {
  if (std::abs(x) < 0.5) {
    const Number s = x * x;
    return x * s * sinh_rest(s);
  }
  return std::sinh(x) - x;
}

/// sinh x, by the series where it is short.
template <class Number>
[[nodiscard]] Number sinh_of(const Number& x) {
  return std::abs(x) < 0.5 ? x + sinh_minus(x) : std::sinh(x);
}

/// e^x - 1.
[[nodiscard]] inline double expm1_of(double x) { return std::expm1(x); }
[[nodiscard]] inline std::complex<double> expm1_of(const std::complex<double>& x) {
  return std::abs(x) < 0.5 ? 2.0 * std::exp(0.5 * x) * sinh_of(0.5 * x) : std::exp(x) - 1.0;
}

/// (-1)^k (4 - 2^k) / k!, k = 3, 4, ...
inline constexpr std::array<double, 18> kBump = [] {
  std::array<double, 18> terms{};
  double factorial = 2.0;
  double two_power = 4.0;
  double sign = 1.0;
  for (std::size_t k = 3; k < terms.size() + 3; ++k) {
    factorial *= static_cast<double>(k);
    two_power *= 2.0;
    sign = -sign;
    terms[k - 3] = sign * (4.0 - two_power) / factorial;
  }
  return terms;
}();

/// p(y) = 2y - 3 + 4 e^-y - e^-2y for a real part that is not negative: for small y the series, exact at eighteen
/// terms.
template <class Number>
[[nodiscard]] Number haar_bump(const Number& y) {
  if (std::abs(y) < 0.5) {
    Number sum = 0.0;
    for (std::size_t k = kBump.size(); k-- > 0;) {
      sum = sum * y + kBump[k];
    }
    return sum * y * y * y;
  }
  const Number t = expm1_of(-y);
  return 2.0 * (y + t) - t * t;
}

}  // namespace driftlab::haar_series
