#pragma once
/// The Whittle likelihood of densities that are linear in unknown levels.
#include <Eigen/Core>

namespace driftlab::investigate {

/// Measured spectra, and the model of their expected density E = fixed + sum_k level_k shape_k, every level_k >= 0.
struct LinearDensity {
  Eigen::VectorXd power, weight, fixed;  ///< by bin: mean P of the ordinates, their number m, the known part of E
  Eigen::MatrixXd shape;                 ///< bins x levels
};
struct LevelFit {
  Eigen::VectorXd level;
  Eigen::MatrixXd covariance;
  double log_likelihood = 0.0;
};
/// Maximum Whittle likelihood by Fisher scoring (weighted least squares with weights m/E^2), levels kept >= 0.
[[nodiscard]] LevelFit fit_levels(const LinearDensity& density, const Eigen::VectorXd& start);

/// The log likelihood of a density: - sum m [ln E + P/E] (Whittle 1953; spectrum.hpp).
[[nodiscard]] double whittle(const Eigen::VectorXd& power, const Eigen::VectorXd& weight,
                             const Eigen::VectorXd& density);

}  // namespace driftlab::investigate
