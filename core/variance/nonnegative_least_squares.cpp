#include "core/variance/nonnegative_least_squares.hpp"

#include "core/process/dense.hpp"

#include <limits>

namespace driftlab {
namespace {

/// Unconstrained solution on the columns in `active`; by QR, so that near-dependent columns keep their digits.
Eigen::VectorXd solve_on(const Eigen::MatrixXd& a, const Eigen::VectorXd& b, const std::vector<Eigen::Index>& active) {
  Eigen::MatrixXd columns(a.rows(), static_cast<Eigen::Index>(active.size()));
  for (std::size_t k = 0; k < active.size(); ++k) {
    columns.col(static_cast<Eigen::Index>(k)) = a.col(active[k]);
  }
  return least_squares(columns, b);
}

}  // namespace

NonnegativeSolution nonnegative_least_squares(const Eigen::Ref<const Eigen::MatrixXd>& a,
                                              const Eigen::Ref<const Eigen::VectorXd>& b) {
  const Eigen::Index columns = a.cols();
  Eigen::VectorXd length = a.colwise().norm().transpose();
  Eigen::MatrixXd scaled = a;
  for (Eigen::Index k = 0; k < columns; ++k) {
    scaled.col(k) /= length(k) > 0.0 ? length(k) : 1.0;
  }
  NonnegativeSolution solution;
  solution.x = Eigen::VectorXd::Zero(columns);
  std::vector<Eigen::Index> active;
  std::vector<bool> barred(static_cast<std::size_t>(columns), false);
  Eigen::VectorXd residual = b;
  const double tolerance = 1e-12 * b.norm();
  for (Eigen::Index round = 0; round < 4 * columns + 4; ++round) {
    const Eigen::VectorXd gradient = scaled.transpose() * residual;
    Eigen::Index entering = -1;
    double steepest = tolerance;
    for (Eigen::Index k = 0; k < columns; ++k) {
      if (solution.x(k) == 0.0 && length(k) > 0.0 && !barred[static_cast<std::size_t>(k)] && gradient(k) > steepest) {
        steepest = gradient(k);
        entering = k;
      }
    }
    if (entering < 0) {
      break;
    }
    active.push_back(entering);
    Eigen::VectorXd trial = solve_on(scaled, b, active);
    if (trial(trial.size() - 1) <= 0.0) {  // rounding: the column cannot enter after all
      active.pop_back();
      barred[static_cast<std::size_t>(entering)] = true;
      continue;
    }
    while (trial.minCoeff() <= 0.0) {  // walk back to the first bound and drop what reached it
      double step = 1.0;
      for (std::size_t k = 0; k < active.size(); ++k) {
        const double value = trial(static_cast<Eigen::Index>(k));
        const double now = solution.x(active[k]);
        if (value <= 0.0) {
          step = std::min(step, now / (now - value));
        }
      }
      std::vector<Eigen::Index> kept;
      for (std::size_t k = 0; k < active.size(); ++k) {
        const double value = trial(static_cast<Eigen::Index>(k));
        double& now = solution.x(active[k]);
        now += step * (value - now);
        if (value <= 0.0 && now <= 1e-14 * solution.x.cwiseAbs().maxCoeff()) {
          now = 0.0;
        } else {
          kept.push_back(active[k]);
        }
      }
      if (kept.size() == active.size()) {
        break;
      }
      active = kept;
      if (active.empty()) {
        break;
      }
      trial = solve_on(scaled, b, active);
    }
    for (std::size_t k = 0; k < active.size(); ++k) {
      solution.x(active[k]) = std::max(0.0, active.empty() ? 0.0 : trial(static_cast<Eigen::Index>(k)));
    }
    residual = b - scaled * solution.x;
  }
  solution.squared_residual = residual.squaredNorm();
  for (Eigen::Index k = 0; k < columns; ++k) {
    solution.x(k) /= length(k) > 0.0 ? length(k) : 1.0;
  }
  return solution;
}

}  // namespace driftlab
