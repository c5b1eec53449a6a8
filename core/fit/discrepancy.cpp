#include "core/fit/discrepancy.hpp"

#include "core/fit/gmwm.hpp"
#include "core/process/dense.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace driftlab {
namespace {

constexpr int kMostSteps = 60;
constexpr double kAccuracy = 0.01;
constexpr double kUndetermined = 1e-14;

/// The positive root in ln delta of a falling function: bracketed by steps of a factor 4 from `first`, then regula
/// falsi on the logarithms with the ends halved in weight where they stay (Illinois).
double falling_root(const std::function<double(double)>& value, double first) {
  double low = first;
  double high = first;
  double low_value = value(first);
  double high_value = low_value;
  for (int step = 0; low_value <= 0.0 && step < kMostSteps; ++step) {
    high = low;
    high_value = low_value;
    low /= 4.0;
    low_value = value(low);
  }
  for (int step = 0; high_value > 0.0 && step < kMostSteps; ++step) {
    low = high;
    low_value = high_value;
    high *= 4.0;
    high_value = value(high);
  }
  int kept = 0;
  double at = std::sqrt(low * high);
  for (int step = 0; step < kMostSteps && high > (1.0 + kAccuracy) * low; ++step) {
    const double share = std::clamp(low_value / (low_value - high_value), 0.05, 0.95);
    at = std::exp(std::log(low) + share * std::log(high / low));
    const double found = value(at);
    if (found > 0.0) {
      low = at;
      low_value = found;
      high_value *= kept < 0 ? 0.5 : 1.0;
      kept = -1;
    } else {
      high = at;
      high_value = found;
      low_value *= kept > 0 ? 0.5 : 1.0;
      kept = 1;
    }
    if (std::fabs(found) < 1e-3) {
      break;
    }
  }
  return at;
}

}  // namespace

double WhitenedCurve::distance(const Eigen::VectorXd& modelled) const {
  const Eigen::VectorXd residual = curve.log_variance.array() - modelled.array().log();
  return (whitening * residual).squaredNorm();
}

WhitenedCurve whitened(CurveCovariance curve, double delta) {
  const Eigen::Index rows = curve.rows();
  return whitened(std::move(curve), Eigen::VectorXd::Constant(rows, delta));
}

WhitenedCurve whitened(CurveCovariance curve, const Eigen::VectorXd& delta) {
  WhitenedCurve result;
  result.delta = delta.size() > 0 ? delta.maxCoeff() : 0.0;
  result.scatter = curve.covariance.raised(delta.cwiseAbs2());
  result.whitening = result.scatter.each(
      [](const BlockDiagonal::Block& block) -> Eigen::MatrixXd { return discrepancy_whitening(block.matrix, 0.0); });
  result.curve = std::move(curve);
  return result;
}

Eigen::MatrixXd discrepancy_whitening(const Eigen::MatrixXd& covariance, double delta) {
  Eigen::MatrixXd sum = covariance;
  sum.diagonal().array() += delta * delta;
  return MomentWeights::from_covariance(sum).whitening();
}

double discrepancy_of(const Eigen::VectorXd& residual, const BlockDiagonal& covariance, double dof) {
  Eigen::ArrayXd squares(residual.size());
  Eigen::ArrayXd values(residual.size());
  for (const BlockDiagonal::Block& block : covariance.blocks()) {
    const Eigen::Index rows = block.matrix.rows();
    const SymmetricEigen eigen = symmetric_eigen(block.matrix);
    squares.segment(block.first, rows) =
        (eigen.vectors.transpose() * residual.segment(block.first, rows)).array().square();
    values.segment(block.first, rows) = eigen.values.array();
  }
  values = values.max(1e-16 * values.maxCoeff()).eval();
  const auto excess = [&](double delta) { return (squares / (values + delta * delta)).sum() - dof; };
  if (!(excess(0.0) > 0.0)) {
    return 0.0;
  }
  return falling_root([&](double delta) { return std::log1p(excess(delta) / dof); },
                      std::max(1e-8, std::sqrt(squares.sum() / static_cast<double>(residual.size()))));
}

double find_discrepancy(const std::function<double(double)>& distance, double dof, double first) {
  if (!(distance(0.0) > dof)) {
    return 0.0;
  }
  return falling_root([&](double delta) { return std::log(distance(delta) / dof); }, first);
}

Eigen::MatrixXd sandwich_covariance(const Eigen::MatrixXd& slope, const BlockDiagonal& scatter) {
  const SymmetricEigen eigen = symmetric_eigen(slope.transpose() * slope);
  const Eigen::MatrixXd loading = slope * eigen.vectors;
  Eigen::MatrixXd middle = scatter.after(loading.transpose()) * loading;
  for (Eigen::Index e = 0; e < middle.rows(); ++e) {
    const double value = eigen.values(e);
    middle.row(e) /= std::max(value, kUndetermined);
    middle.col(e) /= std::max(value, kUndetermined);
    if (value < kUndetermined) {
      middle(e, e) = 1.0 / kUndetermined;
    }
  }
  return eigen.vectors * middle * eigen.vectors.transpose();
}

}  // namespace driftlab
