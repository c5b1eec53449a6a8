#pragma once
/// The bounded square behind the robust wavelet variance: chi(r) = r^2 (1 - (r/c)^2)^4 for |r| < c, and 0 otherwise.
///
/// chi is expanded in Hermite polynomials that are normalised under the standard Gaussian distribution, chi = sum a_k
/// h_k. Then a_0 is the mean of chi, a_2 is its response to the scale of the data, and the even coefficients above a_2
/// are the variance that robustness costs. Mondal and Percival (2012) use the same expansion.
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

  /// Efficiency relative to the classical variance, a_2^2 S_2 / sum_k a_k^2 S_k. `sums` are the correlation sums S_k of
  /// the coefficients (HaarCovariance::correlation_sums).
  [[nodiscard]] double efficiency(const std::array<double, HaarCovariance::kEvenPowers>& sums) const;
};

/// The biweight whose efficiency is `target` for coefficients with these correlation sums; c lies between 2 and 12. The
/// constant for independent data (c = 4.40 for an efficiency of 0.6) does not suit overlapping wavelet coefficients,
/// which are correlated: for white noise at long scales it is 3.69.
[[nodiscard]] Biweight tune_biweight(const std::array<double, HaarCovariance::kEvenPowers>& sums, double target = 0.6);

}  // namespace driftlab
