#pragma once
/// Nonlinear least squares by Levenberg and Marquardt's method: ceres::TinySolver behind a plain function, compiled
/// once.
#include <Eigen/Core>

#include <functional>

namespace driftlab {

/// Residuals r(x) and, unless `jacobian` is null, their derivatives dr_i/dx_k.
using ResidualFunction =
    std::function<void(const Eigen::VectorXd& x, Eigen::VectorXd& residuals, Eigen::MatrixXd* jacobian)>;

/// Where to stop; the names are Ceres'.
struct LeastSquaresLimits {
  int max_iterations = 50;
  double gradient_tolerance = 1e-10;
  double parameter_tolerance = 1e-10;
  double function_tolerance = 1e-10;  ///< of |r|^2 / 2, absolute
  double cost_threshold = 1e-300;     ///< a sum of squares so small is a solution
  double first_trust_radius = 1e4;
};

struct LeastSquaresOutcome {
  double squared_residual = 0.0;  ///< |r|^2 at the end
  bool converged = false;         ///< false: `max_iterations` came first
};

/// Minimises |r(x)|^2 from `x`, which becomes the best point seen. `residuals` is the length of r. Deterministic.
LeastSquaresOutcome levenberg_marquardt(const ResidualFunction& function, Eigen::Index residuals,
                                        const LeastSquaresLimits& limits, Eigen::VectorXd& x);

}  // namespace driftlab
