#pragma once
/// 95 % intervals of Allan and wavelet variances when the noise model is not known.
///
/// The estimate scaled as eta nu^/nu is approximately chi-square with eta = 2 nu^2/Var(nu^) equivalent degrees of
/// freedom (Percival 1995). Var(nu^) requires a noise model, and a model read off the slope of one realisation is
/// misleading. Therefore the whole curve is fitted by non-negative least squares with a dictionary of processes:
/// quantization, white and flicker noise, random walk, and Gauss-Markov processes of beta dt = 2, 1/2, 1/8, ... 0.5/N.
/// The weights come from the fitted variance, in four rounds, and eta is that of the fitted mixture. A drift is
/// admitted only if it lowers the deviance by more than 20, because otherwise a pure random walk is taken for one. The
/// noise is assumed to be linear and its spectrum to be one that the dictionary can describe; observe_scatter()
/// (core/variance/empirical_scatter.hpp) checks that against the record and replaces what does not hold. The measured
/// coverage is 93.5-98 % (tests/ACCURACY.md).
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

/// What the record's own scatter (core/variance/empirical_scatter.hpp) does to a covariance C of the estimates under a
/// model: F (C + c c') F, where F is diagonal. Empty vectors: nothing.
struct ScatterCorrection {
  Eigen::VectorXd factor;  ///< of each standard deviation
  Eigen::VectorXd common;  ///< c [unit^2], what a changing level of the noise adds to all scales at once

  void apply(Eigen::MatrixXd& covariance) const {
    if (factor.size() != 0) {
      covariance = factor.asDiagonal() * (covariance + common * common.transpose()) * factor.asDiagonal();
    }
  }
};

struct VarianceIntervals {
  std::vector<double> edf;
  std::vector<Interval> ci95;         ///< of the wavelet variance; twice that for the Allan variance
  Model mixture;                      ///< the dictionary processes with a positive level
  Eigen::VectorXd modelled;           ///< wavelet variance of the mixture
  Eigen::VectorXd estimate_variance;  ///< Var(nu^_j) under the mixture
  NoiseShape shape;                   ///< the part to which the excess kurtosis was assigned
  ScatterCorrection scatter;          ///< empty while the assumptions above hold
};

/// `plan` must be that of the curve's scales. At least one variance must be positive. `excess` is
/// difference_excess_kurtosis of the samples, or 0 for Gaussian noise; the additional scatter it causes is assigned to
/// the part of the mixture (rough or smooth) that makes up most of the first scale.
[[nodiscard]] VarianceIntervals variance_intervals(const HaarVariance& curve, HaarCovariance& plan,
                                                   double excess = 0.0);

}  // namespace driftlab
