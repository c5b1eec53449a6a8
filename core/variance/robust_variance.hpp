#pragma once
/// Haar wavelet variance that a few gross errors do not move: coefficient by coefficient, with a bounded square.
///
/// nu solves mean chi(W_t/sqrt nu) = E chi(Z), chi of biweight.hpp tuned per scale to an efficiency of 0.6 for the
/// overlap of the coefficients under the model-free mixture. The equation is redescending: the upper root is taken, and
/// a scale without one is undefined (once most windows hold an outlier there is none: 1 % of gross errors, from n = 32
/// on). Every m/8-th coefficient is used (1.5 % more variance). Consistent for Gaussian noise; for noise of another
/// shape it estimates the scale of its core, which differs from the variance without anything being wrong.
#include "core/variance/biweight.hpp"
#include "core/variance/haar_variance.hpp"
#include "core/variance/variance_intervals.hpp"

#include <optional>
#include <span>
#include <vector>

namespace driftlab {

struct RobustVariance {
  std::vector<std::optional<double>> variance;  ///< empty: the equation has no root at this scale
  std::vector<double> efficiency;               ///< against the classical variance, by the expansion
  std::vector<double> edf;                      ///< classical edf times efficiency
  std::vector<Interval> ci95;                   ///< {0, 0} where undefined
  std::vector<Biweight> biweight;
};

/// `samples`, `pivot`: as for haar_variance(). O(N) time per scale up to n = 16, less above; N doubles of memory.
[[nodiscard]] RobustVariance robust_variance(std::span<const double> samples, double pivot, const HaarVariance& curve,
                                             const VarianceIntervals& classical, HaarCovariance& plan);

}  // namespace driftlab
