#pragma once
/// How much a noise level moves from one power-up of a sensor to the next, learnt from sessions in which nothing was
/// changed.
///
/// What a session adds to the rows has the covariance (spec/regression.md, eq. 3)
///   K = kL^2 TL + kS^2 TS,
///   TL[(u,j),(u',j')] = t_d(u) t_d(u') + [u = u'] t_a(u)^2,  TS = [u = u'] t_s(u)^2 exp(-|j - j'|/1.5).
/// The device-wide term couples all axes of a session: one session is one observation of it, not six. Two factors, for
/// the scale-local part has most of the degrees of freedom, and a rig whose scatter is smoother over the scales than
/// TS would teach one common factor too small a value.
///
/// Each factor has the prior p(ln k) ~ k^-v exp(-v/(2 k^2)) on nine points from 0.25 to 6. The likelihood is that of
/// the Helmert contrasts within each arm and each earlier release, each N(0, sum_r h_r^2 S_r/4 + K), over the rows that
/// all sessions of the arm have. One session an arm leaves the prior as it is.
#include "core/campaign/regression/design.hpp"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <stop_token>
#include <vector>

namespace driftlab::regression {

inline constexpr std::size_t kFactors = 9;

/// The points of a factor, equally far apart in their logarithm.
[[nodiscard]] const std::array<double, kFactors>& factor_grid();

/// TL (all rows) and TS (all rows).
struct ScatterTerms {
  Eigen::MatrixXd common;
  Eigen::MatrixXd local;
};
[[nodiscard]] ScatterTerms scatter_terms(const Design& design);

/// The posterior of (kL, kS).
struct SessionScatter {
  /// Rows: kL; columns: kS.
  Eigen::Matrix<double, kFactors, kFactors> posterior = Eigen::Matrix<double, kFactors, kFactors>::Zero();
  std::size_t contrasts = 0;  ///< sessions that inform it, less one per arm or release

  [[nodiscard]] double mean_square_common() const;  ///< E kL^2
  [[nodiscard]] double mean_square_local() const;
  /// Smallest grid point with at least the probability `p` at or below it.
  [[nodiscard]] double quantile_common(double p) const;
  [[nodiscard]] double quantile_local(double p) const;
};

/// `prior_df` is v above. Baseline, candidate and history take part. Cost: 81 Cholesky factors of the size of the rows
/// per set of sessions with equal lengths; `stop` is polled before each; after a stop the result must not be used.
[[nodiscard]] SessionScatter learn_scatter(const Design& design, const ScatterTerms& terms, double prior_df,
                                           const std::stop_token& stop = {});

}  // namespace driftlab::regression
