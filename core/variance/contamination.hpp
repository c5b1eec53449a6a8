#pragma once
/// A test of whether gross errors move the wavelet variances. It compares the robust with the classical estimate at all
/// scales together.
///
/// The statistic is built from d_j = ln(robust_j/classical_j). The classical estimate is the k = 2 Hermite term of the
/// robust one, so d is orthogonal to it, and for Gaussian data
///   Cov(d_i, d_j) = 2/(a2_i a2_j) sum_{k>=4 even} a_ki a_kj S_k^ij
/// holds exactly. d' V^-1 d is then chi-square over the scales with at least 90 equivalent degrees of freedom. At a
/// nominal 5 % the test rejects 4-7 % of clean records. The simpler rule, which asks scale by scale whether one
/// estimate lies outside the interval of the other, rejects 11-19 % of them.
///
/// Clean noise that is not Gaussian (heavy tails throughout, uniform quantization errors) is rejected as well. It is
/// distinguished from gross errors by whether a small share of the coefficients of the first scale carries the excess.
#include "core/variance/robust_variance.hpp"

#include <span>
#include <string_view>
#include <vector>

namespace driftlab {

enum class ContaminationVerdict { Clean, Contaminated, Undecided };

/// `clean`, `contaminated`, `undecided`.
[[nodiscard]] std::string_view name_of(ContaminationVerdict verdict);

struct ContaminationTest {
  ContaminationVerdict verdict = ContaminationVerdict::Undecided;
  double statistic = 0.0;
  double dof = 0.0;
  double p = 1.0;
  /// Share of the first scale's excess of classical over robust variance that coefficients beyond 4.5 robust standard
  /// deviations carry: near 1 for gross errors, small where the noise as a whole has another shape.
  double excess_carried = 0.0;
  std::size_t flagged_coefficients = 0;  ///< of the first scale, beyond 4.5 robust standard deviations
  bool not_gaussian = false;  ///< the two estimates differ, but not by a few samples: report the shape instead
  std::vector<std::size_t> disjoint_scales;   ///< scales n at which the two 95 % intervals do not meet
  std::vector<std::size_t> undefined_scales;  ///< scales n of many degrees of freedom without a robust value
};

/// The verdict is `Contaminated` if p < 0.01 (or no robust value exists at a scale of many degrees of freedom), the
/// robust variance is below the classical one, and at most 10 % of the first scale's coefficients carry at least 40 %
/// of the excess. It is `Clean` if p >= 0.05. It is `Undecided` if p lies between, if the noise has another shape than
/// Gaussian, or if no scale has 90 degrees of freedom. `samples` are those from which `curve` was computed; the
/// variances are in units of `unit_square`.
[[nodiscard]] ContaminationTest test_contamination(std::span<const double> samples, double unit_square,
                                                   const HaarVariance& curve, const VarianceIntervals& classical,
                                                   const RobustVariance& robust, HaarCovariance& plan);

}  // namespace driftlab
