#include "core/investigate/fullrate/whittle.hpp"

#include "core/process/dense.hpp"

#include <cmath>

namespace driftlab::investigate {

double whittle(const Eigen::VectorXd& power, const Eigen::VectorXd& weight, const Eigen::VectorXd& density) {
  double sum = 0.0;
  for (Eigen::Index j = 0; j < power.size(); ++j) {
    sum -= weight[j] * (std::log(density[j]) + power[j] / density[j]);
  }
  return sum;
}

LevelFit fit_levels(const LinearDensity& density, const Eigen::VectorXd& start) {
  LevelFit fit;
  fit.level = start;
  const Eigen::Index levels = density.shape.cols();
  Eigen::VectorXd e = density.fixed + density.shape * fit.level;
  fit.log_likelihood = whittle(density.power, density.weight, e);
  Eigen::MatrixXd information(levels, levels);
  for (int iteration = 0; iteration < 30; ++iteration) {
    const Eigen::VectorXd w = density.weight.cwiseQuotient(e.cwiseAbs2());
    information = density.shape.transpose() * w.asDiagonal() * density.shape;
    Eigen::MatrixXd active = information;
    Eigen::VectorXd score = density.shape.transpose() * w.cwiseProduct(density.power - e);
    for (Eigen::Index k = 0; k < levels; ++k) {
      if (fit.level[k] <= 0.0 && score[k] < 0.0) {  // held at zero
        active.row(k).setZero();
        active.col(k).setZero();
        active(k, k) = 1.0;
        score[k] = 0.0;
      }
    }
    const Eigen::VectorXd step = solve_symmetric(active, score);
    double factor = 1.0;
    bool moved = false;
    for (int attempt = 0; attempt < 12; ++attempt, factor *= 0.5) {
      const Eigen::VectorXd trial = (fit.level + factor * step).cwiseMax(0.0);
      const Eigen::VectorXd there = density.fixed + density.shape * trial;
      if (there.minCoeff() <= 0.0) {
        continue;
      }
      const double l = whittle(density.power, density.weight, there);
      if (l > fit.log_likelihood + 1e-7) {
        fit.level = trial;
        e = there;
        fit.log_likelihood = l;
        moved = true;
        break;
      }
    }
    if (!moved) {
      break;
    }
  }
  fit.covariance = inverse(information + 1e-30 * Eigen::MatrixXd::Identity(levels, levels));
  return fit;
}

}  // namespace driftlab::investigate
