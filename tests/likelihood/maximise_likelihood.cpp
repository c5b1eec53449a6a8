#include "tests/likelihood/kalman_likelihood.hpp"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace driftlab {
namespace {

constexpr double kDifference = 1e-3;  ///< step of the differences, on logarithms
constexpr int kMostRounds = 60;
constexpr double kEnough = 2e-4;  ///< a predicted gain of ln L below this ends the search
constexpr double kLongestStep = 2.0;
constexpr double kFarthest = 60.0;  ///< logarithms of squared levels stay within this of the reference

/// -ln L, its overall level taken out, over the logarithms of squared levels (relative to the one that is largest at
/// the first scale) and of shapes. Drifts have no coordinate.
class Objective {
 public:
  Objective(std::span<const double> samples, const Model& start, double dt_s, const RunControl& control)
      : samples_(samples), model_(start), dt_s_(dt_s), control_(control) {
    std::erase_if(
        model_, [](const Process& process) { return process.kind->symbol != "DR" && !(process.parameters[0] > 0.0); });
    for (std::size_t p = 0; p < model_.size(); ++p) {  // levels are told relative to the one that is largest at first
      if (model_[p].kind->symbol != "DR" &&
          (!reference_ || model_[p].haar_variance(1.0, dt_s) > model_[*reference_].haar_variance(1.0, dt_s))) {
        reference_ = p;
      }
    }
    for (std::size_t p = 0; p < model_.size(); ++p) {
      if (model_[p].kind->symbol == "DR") {
        continue;
      }
      if (p != reference_) {
        coordinates_.push_back({p, 0, 0.0, 0.0});
      }
      for (std::size_t k = 0; k < model_[p].kind->shape_count(); ++k) {
        const auto [low, high] = model_[p].kind->shape_range(k, dt_s, static_cast<double>(samples.size()));
        coordinates_.push_back({p, k + 1, std::log(low), std::log(high)});
      }
    }
  }

  [[nodiscard]] Eigen::Index size() const { return static_cast<Eigen::Index>(coordinates_.size()); }

  [[nodiscard]] Eigen::VectorXd start() const {
    Eigen::VectorXd at(size());
    const double own = level_square(model_[reference_.value_or(0)]);
    for (std::size_t k = 0; k < coordinates_.size(); ++k) {
      const Coordinate& c = coordinates_[k];
      const Process& process = model_[c.process];
      at(static_cast<Eigen::Index>(k)) =
          c.parameter == 0 ? std::log(level_square(process) / own) : std::log(process.parameters[c.parameter]);
    }
    return clamped(at);
  }

  [[nodiscard]] Eigen::VectorXd clamped(Eigen::VectorXd at) const {
    for (std::size_t k = 0; k < coordinates_.size(); ++k) {
      const Coordinate& c = coordinates_[k];
      double& value = at(static_cast<Eigen::Index>(k));
      value = c.parameter == 0 ? std::clamp(value, -kFarthest, kFarthest) : std::clamp(value, c.low, c.high);
    }
    return at;
  }

  /// Infinite where the model has no likelihood.
  double value(const Eigen::VectorXd& at, KalmanLikelihood* out = nullptr) {
    ++evaluations_;
    const Result<KalmanLikelihood> found = kalman_likelihood(samples_, model_at(at, 1.0), dt_s_, control_);
    if (!found) {
      error_ = found.error();
      return std::numeric_limits<double>::infinity();
    }
    if (out != nullptr) {
      *out = *found;
    }
    return -found->scaled_log_likelihood;
  }

  /// All levels times `factor`.
  [[nodiscard]] Model model_at(const Eigen::VectorXd& at, double factor) const {
    Model model = model_;
    const double own = level_square(model_[reference_.value_or(0)]);
    for (std::size_t k = 0; k < coordinates_.size(); ++k) {
      const Coordinate& c = coordinates_[k];
      const double coordinate = at(static_cast<Eigen::Index>(k));
      model[c.process].parameters[c.parameter] =
          c.parameter == 0 ? std::sqrt(own) * std::exp(0.5 * coordinate) : std::exp(coordinate);
    }
    for (Process& process : model) {
      process.parameters[0] *= factor;
    }
    return model;
  }

  [[nodiscard]] const Error& error() const { return error_; }
  [[nodiscard]] int evaluations() const { return evaluations_; }
  [[nodiscard]] bool has_noise() const { return reference_.has_value(); }

 private:
  struct Coordinate {
    std::size_t process;
    std::size_t parameter;
    double low;
    double high;
  };
  static double level_square(const Process& process) { return process.parameters[0] * process.parameters[0]; }

  std::span<const double> samples_;
  Model model_;
  double dt_s_;
  const RunControl& control_;
  std::optional<std::size_t> reference_;
  std::vector<Coordinate> coordinates_;
  Error error_;
  int evaluations_ = 0;
};

struct Slope {
  Eigen::VectorXd gradient;
  Eigen::VectorXd curvature;  ///< diagonal of the second derivatives
};

Slope slope_at(Objective& objective, const Eigen::VectorXd& at, double here) {
  Slope slope{Eigen::VectorXd::Zero(at.size()), Eigen::VectorXd::Zero(at.size())};
  for (Eigen::Index k = 0; k < at.size(); ++k) {
    Eigen::VectorXd up = at;
    Eigen::VectorXd down = at;
    up(k) += kDifference;
    down(k) -= kDifference;
    const double above = objective.value(objective.clamped(up));
    const double below = objective.value(objective.clamped(down));
    if (std::isfinite(above) && std::isfinite(below)) {
      slope.gradient(k) = (above - below) / (2.0 * kDifference);
      slope.curvature(k) = (above + below - 2.0 * here) / (kDifference * kDifference);
    }
  }
  return slope;
}

Eigen::MatrixXd first_metric(const Slope& slope) {
  Eigen::VectorXd inverse(slope.curvature.size());
  for (Eigen::Index k = 0; k < inverse.size(); ++k) {
    inverse(k) = 1.0 / std::max({slope.curvature(k), std::fabs(slope.gradient(k)), 0.5});
  }
  return inverse.asDiagonal();
}

/// Broyden, Fletcher, Goldfarb and Shanno's update of the inverse Hessian.
void update(Eigen::MatrixXd& metric, const Eigen::VectorXd& step, const Eigen::VectorXd& change) {
  const double along = step.dot(change);
  if (!(along > 1e-12 * step.norm() * change.norm())) {
    return;
  }
  const Eigen::VectorXd moved = metric * change;
  metric += (1.0 + change.dot(moved) / along) / along * step * step.transpose() -
            (moved * step.transpose() + step * moved.transpose()) / along;
}

}  // namespace

Result<LikelihoodFit> maximise_likelihood(std::span<const double> samples, const Model& start, double dt_s,
                                          const RunControl& control) {
  Objective objective(samples, start, dt_s, control);
  if (start.empty() || !objective.has_noise()) {
    return fail(ErrorCode::InvalidArgument, "A likelihood needs a model with noise in it.");
  }
  Eigen::VectorXd at = objective.start();
  double here = objective.value(at);
  if (!std::isfinite(here)) {
    return fail(objective.error());
  }
  LikelihoodFit fit;
  fit.converged = at.size() == 0;
  Slope slope = slope_at(objective, at, here);
  Eigen::MatrixXd metric = first_metric(slope);
  for (int round = 0; round < kMostRounds && !fit.converged; ++round) {
    Eigen::VectorXd direction = -metric * slope.gradient;
    if (!(direction.dot(slope.gradient) < 0.0)) {
      metric = first_metric(slope);
      direction = -metric * slope.gradient;
    }
    const double longest = direction.cwiseAbs().maxCoeff();
    direction *= std::min(1.0, kLongestStep / std::max(longest, 1e-300));
    const double promised = -direction.dot(slope.gradient);
    if (promised < kEnough) {
      fit.converged = true;
      break;
    }
    double fraction = 1.0;
    Eigen::VectorXd next = objective.clamped(at + direction);
    double there = objective.value(next);
    while (!(there <= here - 1e-4 * fraction * promised) && fraction > 1e-4) {
      fraction *= 0.3;
      next = objective.clamped(at + fraction * direction);
      there = objective.value(next);
    }
    if (control.stop.stop_requested()) {
      return fail(ErrorCode::Cancelled, "The likelihood was cancelled.");
    }
    if (!(there < here)) {
      fit.converged = promised < 0.05;
      break;
    }
    const Slope arrived = slope_at(objective, next, there);
    update(metric, next - at, arrived.gradient - slope.gradient);
    fit.converged = here - there < 0.1 * kEnough;
    at = next;
    here = there;
    slope = arrived;
  }
  KalmanLikelihood best;
  (void)objective.value(at, &best);
  fit.model = objective.model_at(at, std::sqrt(best.scale));
  for (Process& process : fit.model) {
    if (process.kind->symbol == "DR") {
      process.parameters[0] = std::fabs(best.slope);
    }
  }
  fit.likelihood = best;
  fit.likelihood.log_likelihood = best.scaled_log_likelihood;
  fit.likelihood.scale = 1.0;
  fit.likelihood.mean_sd *= std::sqrt(best.scale);
  fit.likelihood.slope_sd *= std::sqrt(best.scale);
  fit.evaluations = objective.evaluations();
  return fit;
}

}  // namespace driftlab
