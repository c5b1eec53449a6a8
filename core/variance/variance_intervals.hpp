#pragma once
/// 95 % intervals of Allan and wavelet variances whose noise model nobody knows.
///
/// nu^ eta/nu ~ chi-square(eta) with eta = 2 nu^2/Var(nu^) (Percival 1995). Var needs a noise model; reading it off the
/// slope of one realisation misleads, so the whole curve is fitted by non-negative least squares with a dictionary of
/// processes (quantization, white, flicker, random walk, Gauss-Markov of beta dt = 2, 1/2, 1/8, ... 0.5/N), weights
/// from the fitted variance, four rounds, and eta is that of the fitted mixture. A drift enters only where the deviance
/// falls by more than 20: a pure random walk looks like one otherwise. Assumes Gaussian noise. Measured
/// coverage 93.5-98 % (tests/ACCURACY.md).
#include "core/process/model.hpp"
#include "core/signal/estimate.hpp"
#include "core/variance/excess_kurtosis.hpp"
#include "core/variance/haar_covariance.hpp"
#include "core/variance/haar_variance.hpp"

#include <Eigen/Core>

#include <vector>

namespace driftlab {

/// [eta nu/chi2_.975, eta nu/chi2_.025]; {0, 0} for nu = 0.
[[nodiscard]] Interval chi_square_interval(double variance, double edf);

struct VarianceIntervals {
  std::vector<double> edf;
  std::vector<Interval> ci95;         ///< of the wavelet variance; twice that for the Allan variance
  Model mixture;                      ///< the dictionary processes with a positive level
  Eigen::VectorXd modelled;           ///< wavelet variance of the mixture
  Eigen::VectorXd estimate_variance;  ///< Var(nu^_j) under the mixture
  NoiseShape shape;                   ///< what the excess kurtosis was laid on
};

/// `plan` must be that of the curve's scales. Needs at least one positive variance. `excess`:
/// difference_excess_kurtosis of the samples, 0 for Gaussian noise; its share of the scatter is laid on the part of the
/// mixture (rough or smooth) that makes up most of the first scale.
[[nodiscard]] VarianceIntervals variance_intervals(const HaarVariance& curve, HaarCovariance& plan,
                                                   double excess = 0.0);

}  // namespace driftlab
