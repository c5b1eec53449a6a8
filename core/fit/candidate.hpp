#pragma once
/// The fit of one candidate model, and the criteria that rank the candidates.
///
/// The fit has three steps. (1) GMWM with the diagonal weights 1/Var(nu^_j) of the model-free mixture. (2) GMWM twice
/// more, with the inverse of the covariance that the previous fit implies (optimal weighting in two steps, Hansen
/// 1982). (3) The quasi-likelihood on the logarithms of the variances, for the test of fit and the intervals.
///
/// The criterion is L + p ln N. L is the least squared distance on the logarithms under each model's own covariance
/// (LogFit). p counts the parameters of the structure, those of vanished components too, so that a model with a
/// vanished component loses to the model without it. This is the moment-selection criterion of BIC type (Andrews 1999;
/// Andrews and Lu 2001), with a J statistic that is chi-square at the longest scales too. Its performance on simulated
/// phone data (N = 90,000) stands in tests/ACCURACY.md. The models whose L + 2p is within 6 of the best cannot be told
/// apart by the data.
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

/// Covariance of the moments under a model: for one recording that of a HaarCovariance, for a stack of recordings the
/// block-diagonal matrix of theirs.
using CovarianceLaw = std::function<Eigen::MatrixXd(const Model&)>;
[[nodiscard]] Candidate fit_candidate(const WaveletMoments& moments, const ModelStructure& structure,
                                      const Eigen::VectorXd& sd, const CovarianceLaw& covariance_of);

/// The two terms of equation (8) of the seed paper.
struct Equation8 {
  double distance = 0.0;  ///< (nu^ - nu)' W (nu^ - nu)
  double optimism = 0.0;  ///< 2 tr(W C W D (D'WD)^-1 D') >= 0
  [[nodiscard]] double value() const { return distance + optimism; }
};

/// Equation (8) with its optimism term. W are the diagonal weights, C is one covariance for all candidates, and D are
/// the derivatives with respect to the parameters of the active components. The trace is that of a projector times a
/// covariance, so it is never negative; with W = C^-1 it would be 2 p.
[[nodiscard]] Equation8 equation_8(const WaveletMoments& moments, const GmwmSolution& solution,
                                   const Eigen::VectorXd& sd, const Eigen::MatrixXd& covariance);

}  // namespace driftlab
