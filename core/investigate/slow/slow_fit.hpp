#pragma once
/// Maximum likelihood estimation of the slow part: amplitudes of mean effects and parameters of the noise together.
///
/// Let W be the whitening of a noise model (slow_model.hpp). The amplitudes a of the regressors X follow by generalised
/// least squares, a = (X'W'WX)^-1 X'W'Wy. The noise parameters theta (logarithms of levels and betas) follow by Fisher
/// scoring on the profile likelihood. With innovations v_b and variances S_b,
///   score_i = -1/2 sum [ dS_i/S + 2 v dv_i/S - v^2 dS_i/S^2 ],
///   information_ij = sum [ dv_i dv_j/S + dS_i dS_j/(2 S^2) ]
/// (Harvey 1989, eqs. 3.4.69 and 3.4.71). Mean and noise parameters are orthogonal in the information of a Gaussian, so
/// cov(a) = (X'W'WX)^-1 to first order. `profile_interval` is the exact counterpart, in which the noise is refitted.
#include "core/investigate/slow/profile.hpp"
#include "core/investigate/slow/slow_model.hpp"
#include "core/signal/estimate.hpp"

#include <Eigen/Core>

#include <limits>
#include <stop_token>
#include <vector>

namespace driftlab::investigate {

/// Which parameters a fit may move: the white level, and the components from `first_free` on.
struct SlowFreedom {
  bool white = true;
  std::size_t first_free = 0;
  int iterations = 25;
  std::stop_token stop = {};  ///< once requested, the fit ends where it is
};

/// One noise parameter: component index, or kWhite.
struct SlowParameter {
  static constexpr std::size_t kWhite = std::numeric_limits<std::size_t>::max();
  std::size_t component = kWhite;
  bool beta = false;
  friend bool operator==(const SlowParameter&, const SlowParameter&) = default;
};

struct SlowFit {
  SlowModel model;
  Eigen::VectorXd amplitude;             ///< one per regressor
  Eigen::MatrixXd amplitude_covariance;  ///< (X'W'WX)^-1
  double log_likelihood = -std::numeric_limits<double>::infinity();
  std::vector<SlowParameter> parameters;  ///< the free ones
  Eigen::MatrixXd information;            ///< of their logarithms
  bool converged = false;
};

/// `columns`: the data first, then the regressors. `start` gives structure and first values.
[[nodiscard]] SlowFit fit_slow(const BlockSeries& series, const BlockColumns& columns, const SlowModel& start,
                               const SlowFreedom& freedom = {});

/// The likelihood at a model as it stands, amplitudes profiled out.
[[nodiscard]] SlowFit evaluate_slow(const BlockSeries& series, const BlockColumns& columns, const SlowModel& model);

/// Generalised least squares on whitened columns: the residual sum of squares and the amplitudes.
struct LeastSquares {
  Eigen::VectorXd amplitude;
  Eigen::MatrixXd covariance;
  double residual = 0.0;
};
[[nodiscard]] LeastSquares solve_whitened(const BlockColumns& whitened);

/// 95 % interval of the amplitude of regressor `column` (1 is the first) by the profile likelihood: the values at which
/// twice the log likelihood, noise parameters and other amplitudes refitted, lies 3.84 below the top.
[[nodiscard]] Interval profile_amplitude(const BlockSeries& series, const BlockColumns& columns, const SlowFit& fit,
                                         std::size_t column, const SlowFreedom& freedom);

/// The same for one noise parameter (a level as such, not its logarithm). An end that the data do not bound is the
/// bound of the search.
[[nodiscard]] Interval profile_parameter(const BlockSeries& series, const BlockColumns& columns, const SlowFit& fit,
                                         const SlowParameter& parameter, const SlowFreedom& freedom);

}  // namespace driftlab::investigate
