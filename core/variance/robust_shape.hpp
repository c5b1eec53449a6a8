#pragma once
/// What the shape of clean noise does to the coefficient-wise robust variance, so that it can be undone.
///
/// The biweight is consistent for Gaussian coefficients. Two clean laws are not Gaussian and are known well enough to
/// correct for: quantization noise of uniform errors, whose coefficients are (a - 2b + c)/sqrt 6 of three independent
/// uniforms at every scale (excess kurtosis -0.6; uncorrected, the robust estimate is 17 % high), and the values of a
/// coarse lattice at the shortest scales (core/variance/lattice.hpp).
#include "core/variance/biweight.hpp"
#include "core/variance/variance_intervals.hpp"

#include <cstddef>
#include <vector>

namespace driftlab {

/// One entry per scale, or none where nothing is to be corrected.
struct RobustShape {
  std::vector<double> uniform_share;  ///< share of the scale's variance that uniform quantization errors make up
  /// Of a coarse lattice, for its first scales: the biweight to use there, its mean over clean data of this shape, what
  /// is left of ln(robust/classical), all from simulation.
  std::vector<Biweight> biweight;
  std::vector<double> expected;
  std::vector<double> log_ratio;
  std::vector<double> inflation;  ///< variance of ln(robust/classical) over that of Gaussian data, at least 1
  bool refused = false;           ///< a lattice too coarse for any robust value

  [[nodiscard]] double uniform_at(std::size_t j) const { return uniform_share.empty() ? 0.0 : uniform_share[j]; }
  [[nodiscard]] bool simulated(std::size_t j) const { return j < biweight.size(); }
  /// Of ln(robust/classical) against Gaussian data. Uniform errors lower it: 1 - 0.6 share^4 is a fit to simulations at
  /// shares of 0.7 to 1, good to a tenth.
  [[nodiscard]] double inflation_at(std::size_t j) const {
    const double square = uniform_at(j) * uniform_at(j);
    return simulated(j) ? inflation[j] : 1.0 - 0.6 * square * square;
  }
};

/// E chi(W) for W of variance 1 whose share `uniform_share` is three-point differences of uniform errors and whose rest
/// is Gaussian: the Hermite expansion of chi with the moments that the cumulants of W give (to order 16).
[[nodiscard]] double mean_with_uniform_share(const Biweight& biweight, double uniform_share);

/// Share of quantization noise in the modelled variance of scale `j`.
[[nodiscard]] double quantization_share(const VarianceIntervals& intervals, const HaarCovariance& plan, std::size_t j);

/// Uniform shares per scale where the mixture holds quantization noise and `excess`, the excess kurtosis of the first
/// differences, is at least half of what uniform errors would give them; none otherwise.
[[nodiscard]] RobustShape quantization_shape(const VarianceIntervals& intervals, const HaarCovariance& plan,
                                             double excess);

}  // namespace driftlab
