#include "core/fit/levenberg_marquardt.hpp"

#include <ceres/tiny_solver.h>

namespace driftlab {
namespace {

/// A ResidualFunction in the form ceres::TinySolver asks for.
class CeresForm {
 public:
  using Scalar = double;
  // NOLINTNEXTLINE(readability-identifier-naming): names are Ceres'
  enum { NUM_RESIDUALS = Eigen::Dynamic, NUM_PARAMETERS = Eigen::Dynamic };

  CeresForm(const ResidualFunction& function, Eigen::Index residuals, Eigen::Index parameters)
      : function_(function), residuals_(residuals), parameters_(parameters) {}
  [[nodiscard]] int NumResiduals() const { return static_cast<int>(residuals_); }    // NOLINT
  [[nodiscard]] int NumParameters() const { return static_cast<int>(parameters_); }  // NOLINT

  bool operator()(const double* x, double* residuals, double* jacobian) const {
    Eigen::VectorXd r;
    Eigen::MatrixXd derivatives;
    function_(Eigen::Map<const Eigen::VectorXd>(x, parameters_), r, jacobian != nullptr ? &derivatives : nullptr);
    Eigen::Map<Eigen::VectorXd>(residuals, residuals_) = r;
    if (jacobian != nullptr) {
      Eigen::Map<Eigen::MatrixXd>(jacobian, residuals_, parameters_) = derivatives;
    }
    return true;
  }

 private:
  const ResidualFunction& function_;
  Eigen::Index residuals_;
  Eigen::Index parameters_;
};

}  // namespace

LeastSquaresOutcome levenberg_marquardt(const ResidualFunction& function, Eigen::Index residuals,
                                        const LeastSquaresLimits& limits, Eigen::VectorXd& x) {
  const CeresForm form(function, residuals, x.size());
  ceres::TinySolver<CeresForm> solver;
  solver.options.max_num_iterations = limits.max_iterations;
  solver.options.gradient_tolerance = limits.gradient_tolerance;
  solver.options.parameter_tolerance = limits.parameter_tolerance;
  solver.options.function_tolerance = limits.function_tolerance;
  solver.options.cost_threshold = limits.cost_threshold;
  solver.options.initial_trust_region_radius = limits.first_trust_radius;
  const auto& summary = solver.Solve(form, &x);
  return {2.0 * summary.final_cost, summary.status != ceres::TinySolver<CeresForm>::HIT_MAX_ITERATIONS};
}

}  // namespace driftlab
