#pragma once
/// Do gross errors move the wavelet variances? A test of the robust against the classical estimate over all scales at
/// once.
///
/// d_j = ln(robust_j/classical_j). The classical estimate is the k = 2 Hermite term of the robust one, so d is
/// orthogonal to it and Cov(d_i, d_j) = 2/(a2_i a2_j) sum_{k>=4 even} a_ki a_kj S_k^ij is exact for Gaussian data; d'
/// V^-1 d is chi-square over the scales with at least 90 equivalent degrees of freedom. Size at 5 %: 4-7 %. Judging
/// scale by scale whether one estimate lies outside the interval of the other errs in 11-19 % of clean records.
/// Noise of another shape than Gaussian (heavy tails throughout, uniform quantization errors) is rejected as well; it
/// is told from gross errors by asking whether few coefficients of the first scale carry the excess.
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

/// Contaminated: p < 0.01 (or no robust value at a scale of many degrees of freedom), robust below classical, and at
/// most 10 % of the first scale's coefficients carry at least 40 % of the excess. Clean: p >= 0.05. Undecided: between,
/// another shape, or no scale with 90 degrees of freedom. `samples`: those of the curve, whose variances are in units
/// of `unit_square`.
[[nodiscard]] ContaminationTest test_contamination(std::span<const double> samples, double unit_square,
                                                   const HaarVariance& curve, const VarianceIntervals& classical,
                                                   const RobustVariance& robust, HaarCovariance& plan);

}  // namespace driftlab
