#pragma once
/// One candidate model through all steps of the estimator, and the criteria that rank it.
///
/// Steps: GMWM with diagonal weights 1/Var(nu^_j) of the model-free mixture; twice more with the inverse of the
/// covariance that the last fit implies (optimal weighting in two steps, Hansen 1982); quasi-likelihood on the
/// logarithms for test and intervals.
///
/// Criterion: L + p ln N, with L the least squared distance on the logarithms under each model's own covariance
/// (LogFit) and p the parameters of the structure, vanished ones too (a model with a dead component loses to the one
/// without). It is the moment-selection criterion of BIC type (Andrews 1999; Andrews and Lu 2001) with a J statistic
/// that is chi-square at the longest scales too. Measured on simulated phone data (N = 90,000): tests/ACCURACY.md. The
/// set of models whose L + 2p is within 6 of the best is what the data cannot tell apart.
#include "core/fit/gmwm.hpp"
#include "core/fit/log_fit.hpp"
#include "core/variance/haar_covariance.hpp"

#include <Eigen/Core>

#include <functional>
#include <memory>
#include <optional>
#include <vector>

namespace driftlab {

struct Candidate {
  ModelStructure structure;
  GmwmSolution diagonal;          ///< fit under the diagonal weights
  GmwmSolution fit;               ///< fit under the model-implied weights
  Eigen::MatrixXd covariance;     ///< of the wavelet variances under `fit`
  double quasi_likelihood = 0.0;  ///< e' C^-1 e + ln det C
  double eq8 = 0.0;               ///< equation_8(...).value()
  double optimism = 0.0;          ///< equation_8(...).optimism
  std::size_t parameters = 0;
  std::unique_ptr<LogFit> log_fit;  ///< over the positive components; null where nothing is positive

  [[nodiscard]] double criterion(double samples) const;
};

/// `sd`: standard deviations of the wavelet variances for the diagonal weights.
[[nodiscard]] Candidate fit_candidate(const WaveletMoments& moments, const ModelStructure& structure,
                                      const Eigen::VectorXd& sd, HaarCovariance& plan);

/// Covariance of the moments under a model: of one recording a HaarCovariance's, of a stack of them block by block.
using CovarianceLaw = std::function<Eigen::MatrixXd(const Model&)>;
[[nodiscard]] Candidate fit_candidate(const WaveletMoments& moments, const ModelStructure& structure,
                                      const Eigen::VectorXd& sd, const CovarianceLaw& covariance_of);

/// Seed paper eq. 8 in its two terms.
struct Equation8 {
  double distance = 0.0;  ///< (nu^ - nu)' W (nu^ - nu)
  double optimism = 0.0;  ///< 2 tr(W C W D (D'WD)^-1 D') >= 0
  [[nodiscard]] double value() const { return distance + optimism; }
};

/// Eq. 8 with the optimism derived for it, W the diagonal weights, C one covariance for all candidates, D the
/// derivatives of the active components. The trace is that of a projector times a covariance, so it is never negative;
/// with W = C^-1 it would be 2 p.
[[nodiscard]] Equation8 equation_8(const WaveletMoments& moments, const GmwmSolution& solution,
                                   const Eigen::VectorXd& sd, const Eigen::MatrixXd& covariance);

}  // namespace driftlab
