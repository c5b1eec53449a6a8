#pragma once
/// Corrections to the coefficient-wise robust variance for clean noise that is not Gaussian.
///
/// The biweight estimator is consistent for Gaussian coefficients. Two kinds of clean noise are not Gaussian and are
/// known well enough to be corrected for. One is quantization noise of uniform errors: its coefficients are (a - 2b +
/// c)/sqrt 6 of three independent uniform variables at every scale, with excess kurtosis -0.6, and uncorrected the
/// robust estimate is 17 % too high. The other is the set of few values that a coarse lattice leaves at the shortest
/// scales (core/variance/lattice.hpp).
#include "core/variance/biweight.hpp"
#include "core/variance/variance_intervals.hpp"

#include <cstddef>
#include <vector>

namespace driftlab {

/// One entry per scale, or none where nothing is to be corrected.
struct RobustShape {
  std::vector<double> uniform_share;  ///< share of the scale's variance that uniform quantization errors make up
  /// For a coarse lattice, at its first scales: the biweight to use, its mean over clean data of this shape, and the
  /// remaining bias of ln(robust/classical). All three come from simulation.
  std::vector<Biweight> biweight;
  std::vector<double> expected;
  std::vector<double> log_ratio;
  std::vector<double> inflation;  ///< variance of ln(robust/classical) over that of Gaussian data, at least 1
  bool refused = false;           ///< a lattice too coarse for any robust value

  [[nodiscard]] double uniform_at(std::size_t j) const { return uniform_share.empty() ? 0.0 : uniform_share[j]; }
  [[nodiscard]] bool simulated(std::size_t j) const { return j < biweight.size(); }
  /// Variance of ln(robust/classical) relative to Gaussian data. Uniform errors lower it: 1 - 0.6 share^4 was fitted to
  /// simulations at shares of 0.7 to 1 and is good to a tenth.
  [[nodiscard]] double inflation_at(std::size_t j) const {
    const double square = uniform_at(j) * uniform_at(j);
    return simulated(j) ? inflation[j] : 1.0 - 0.6 * square * square;
  }
};

/// E chi(W) for a W of variance 1, of which the share `uniform_share` consists of three-point differences of uniform
/// errors and the rest is Gaussian. It is the Hermite expansion of chi with the moments that follow from the cumulants
/// of W, to order 16.
[[nodiscard]] double mean_with_uniform_share(const Biweight& biweight, double uniform_share);

/// Share of quantization noise in the modelled variance of scale `j`.
[[nodiscard]] double quantization_share(const VarianceIntervals& intervals, const HaarCovariance& plan, std::size_t j);

/// Uniform shares per scale, if the mixture holds quantization noise and `excess`, the excess kurtosis of the first
/// differences, is at least half of what uniform errors would give. Empty otherwise.
[[nodiscard]] RobustShape quantization_shape(const VarianceIntervals& intervals, const HaarCovariance& plan,
                                             double excess);

}  // namespace driftlab
