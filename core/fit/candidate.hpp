#pragma once
/// The fit of one candidate model, and the criteria that rank the candidates.
///
/// The fit minimises L, the squared distance on the logarithms of the variances under the one covariance and the one
/// discrepancy of the curve (LogFit). The search starts from the GMWM fit with diagonal weights, which needs no
/// starting values, and from the minima of models that lack one of the processes (nested_start.hpp). The model keeps
/// the least distance found; where that is a smaller model's, the additional processes have vanished. So L of a model
/// is never above that of a model it contains.
///
/// The criterion adds p ln N to the distance (BIC type: Andrews 1999; Andrews and Lu 2001); p counts the parameters of
/// the structure, those of vanished components too, so that a model with a vanished component loses to the model
/// without it. If the J test accepts a candidate, so that the discrepancy of the curve is 0, each candidate is ranked
/// by its least L under the covariance that its own fit implies: the true model then has the right scatter, and a model
/// without a slow process implies too little scatter to excuse its misfit. (With the covariance of the curve for all,
/// WN+GM+RW is found in 63 instead of 93 % of phone records of 15 min.) A model is given at most the distance of any
/// model that it contains, whose covariance it can imply too. If the curve has a discrepancy, no candidate is true:
/// candidates are ranked by L itself, and each parameter costs the logarithm of the number of scales, since each scale
/// is then one observation of a regression. Models whose ranked distance + 2p is within 6 of the best cannot be told
/// apart by the data.
#include "core/fit/gmwm.hpp"
#include "core/fit/log_fit.hpp"

#include <Eigen/Core>

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace driftlab {

struct Candidate {
  ModelStructure structure;
  GmwmSolution diagonal;            ///< fit under the diagonal weights
  GmwmSolution fit;                 ///< fit of least L; its objective is L
  double eq8 = 0.0;                 ///< equation_8(...).value()
  double optimism = 0.0;            ///< equation_8(...).optimism
  std::size_t parameters = 0;       ///< of the components that have not vanished
  double test_distance = 0.0;       ///< its J statistic at delta = 0 (j_test.hpp)
  std::size_t test_parameters = 0;  ///< `parameters` there
  std::unique_ptr<LogFit> log_fit;  ///< over the positive components; null where nothing is positive

  /// Least L under the covariance that the fit implies; empty if candidates are ranked by L itself.
  std::optional<double> own_distance = std::nullopt;

  /// The distance by which candidates are ranked.
  [[nodiscard]] double ranked_distance() const { return own_distance ? *own_distance : log_fit->minimum(); }
  [[nodiscard]] double criterion(double samples) const;
  /// Updates the members from `log_fit` after another search has lowered its minimum.
  void settle();
};

/// `sd`: standard deviations of the wavelet variances for the diagonal weights. `known`: fits to the same curve; the
/// minima of those that are contained in `structure` are starts.
[[nodiscard]] Candidate fit_candidate(const WaveletMoments& moments, const ModelStructure& structure,
                                      const Eigen::VectorXd& sd, const std::shared_ptr<const WhitenedCurve>& curve,
                                      std::span<const Candidate> known = {});

/// The same model under the curve with another discrepancy; its fit so far is one more start. Keeps the
/// figures that do not depend on the discrepancy.
[[nodiscard]] Candidate refit_candidate(const WaveletMoments& moments, const Candidate& before,
                                        const std::shared_ptr<const WhitenedCurve>& curve,
                                        std::span<const Candidate> known = {});

/// Covariance of the wavelet variances under a model [unit^4].
using CovarianceLaw = std::function<BlockDiagonal(const Model&)>;

/// The least distance of a candidate under the covariance of its own fit.
[[nodiscard]] double distance_under_own(const WaveletMoments& moments, const Candidate& candidate,
                                        const CovarianceLaw& covariance_of);

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
