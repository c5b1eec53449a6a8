#pragma once
/// The bounded square behind the robust wavelet variance: chi(r) = r^2 (1 - (r/c)^2)^4 inside |r| < c, 0 outside.
///
/// Expanded in Hermite polynomials normalised under the Gaussian, chi = sum a_k h_k: a_0 is its mean, a_2 carries the
/// scale, and the even a_k above 2 are what robustness costs (Mondal and Percival 2012 use the same expansion).
#include "core/variance/haar_covariance.hpp"

#include <array>
#include <cstddef>

namespace driftlab {

struct Biweight {
  double c = 4.4;                                             ///< in standard deviations
  double mean = 0.0;                                          ///< E chi(Z)
  std::array<double, HaarCovariance::kEvenPowers> hermite{};  ///< a_2, a_4, ..., a_16

  /// Expansion for a given c, by quadrature.
  [[nodiscard]] static Biweight with(double c);

  /// Efficiency against the classical variance, a_2^2 S_2 / sum_k a_k^2 S_k, for coefficients whose correlation sums
  /// are S.
  [[nodiscard]] double efficiency(const std::array<double, HaarCovariance::kEvenPowers>& sums) const;
};

/// The biweight whose efficiency is `target` for coefficients with these correlation sums; c between 2 and 12. What is
/// right for independent data (c = 4.40 for 0.6) is not right for overlapping coefficients: 3.69 for white noise at
/// long scales.
[[nodiscard]] Biweight tune_biweight(const std::array<double, HaarCovariance::kEvenPowers>& sums, double target = 0.6);

}  // namespace driftlab
