#pragma once
/// The Whittle likelihood of densities that are linear in unknown levels.
#include <Eigen/Core>

namespace driftlab::investigate {

/// Densities linear in unknown levels: E = fixed + sum_k level_k shape_k, levels >= 0 where `positive`.
struct LinearDensity {
  Eigen::VectorXd power, weight, fixed;
  Eigen::MatrixXd shape;  ///< bins x levels
};
struct LevelFit {
  Eigen::VectorXd level;
  Eigen::MatrixXd covariance;
  double log_likelihood = 0.0;
};
/// Maximum Whittle likelihood by Fisher scoring (weighted least squares with weights m/E^2), levels kept >= 0.
[[nodiscard]] LevelFit fit_levels(const LinearDensity& density, const Eigen::VectorXd& start);

/// - sum m [ln E + P/E].
[[nodiscard]] double whittle(const Eigen::VectorXd& power, const Eigen::VectorXd& weight,
                             const Eigen::VectorXd& density);

}  // namespace driftlab::investigate
