#include "core/fit/log_fit.hpp"

#include "core/fit/levenberg_marquardt.hpp"
#include "core/process/dense.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace driftlab {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr int kMaxRestarts = 20;

}  // namespace

LogFit::LogFit(const WaveletMoments& moments, Model model, std::shared_ptr<const WhitenedCurve> curve)
    : moments_(moments), model_(std::move(model)), curve_(std::move(curve)) {
  const auto contribution = [&](Process process) {  // largest and smallest share of the curve at level 1
    process.parameters[0] = 1.0;
    std::pair<double, double> extremes{0.0, kInfinity};
    for (const Eigen::Index j : curve_->curve.used) {
      const auto row = static_cast<std::size_t>(j);
      const double share = process.haar_variance(moments.half[row], moments.dt_at(row)) / moments.nu(j);
      extremes.first = std::max(extremes.first, share);
      extremes.second = std::min(extremes.second, share);
    }
    return extremes;
  };
  std::vector<double> start;
  for (std::size_t p = 0; p < model_.size(); ++p) {
    const Process& process = model_[p];
    const double square = process.parameters[0] * process.parameters[0];
    const auto [most, least] = contribution(process);
    const double at = std::log(square);
    coordinates_.push_back(
        {p, 0, -std::log(most) - 18.0, std::max(at, -std::log(std::max(least, most * 1e-12))) + 8.0});
    start.push_back(at);
  }
  for (std::size_t p = 0; p < model_.size(); ++p) {
    for (std::size_t k = 0; k < model_[p].kind->shape_count(); ++k) {
      const auto [low, high] = model_[p].kind->shape_range(k, moments.dt_s, moments.samples);
      coordinates_.push_back({p, k + 1, std::log(low), std::log(high)});
      start.push_back(std::log(model_[p].parameters[k + 1]));
    }
  }
  best_ = Eigen::Map<Eigen::VectorXd>(start.data(), static_cast<Eigen::Index>(start.size()));
  minimum_ = minimise(best_, std::nullopt);
}

Model LogFit::model_at(const Eigen::VectorXd& coordinates) const {
  Model model = model_;
  for (std::size_t k = 0; k < coordinates_.size(); ++k) {
    const LogCoordinate& c = coordinates_[k];
    const double value = std::clamp(coordinates(static_cast<Eigen::Index>(k)), c.low, c.high);
    model[c.process].parameters[c.parameter] = c.parameter == 0 ? std::exp(0.5 * value) : std::exp(value);
  }
  return model;
}

double LogFit::evaluate(const Eigen::VectorXd& coordinates, Eigen::VectorXd* residual,
                        Eigen::MatrixXd* jacobian) const {
  const Model model = model_at(coordinates);
  const std::vector<Eigen::Index>& used = curve_->curve.used;
  const Eigen::Index count = scales();
  Eigen::VectorXd raw(count);
  Eigen::MatrixXd slope;
  if (jacobian != nullptr) {
    slope.resize(count, static_cast<Eigen::Index>(coordinates_.size()));
  }
  const std::size_t rows = moments_.half.size();
  std::vector<double> shares(rows * model.size());
  std::vector<double> gradients(jacobian != nullptr ? rows * coordinates_.size() : 0);
  std::vector<std::span<const double>> gradient(model.size());
  std::size_t taken = 0;
  for (std::size_t p = 0; p < model.size(); ++p) {
    const std::size_t wanted =
        jacobian != nullptr && model[p].kind->has_shape() ? rows * model[p].parameters.size() : 0;
    const std::span<double> slopes = std::span(gradients).subspan(taken, wanted);
    curve_of(*model[p].kind, model[p].parameters, moments_, std::span(shares).subspan(p * rows, rows), slopes);
    gradient[p] = slopes;
    taken += wanted;
  }
  for (Eigen::Index j = 0; j < count; ++j) {
    const auto row = static_cast<std::size_t>(used[static_cast<std::size_t>(j)]);
    double sum = 0.0;
    for (std::size_t p = 0; p < model.size(); ++p) {
      sum += shares[p * rows + row];
    }
    raw(j) = curve_->curve.log_variance(j) - std::log(sum);
    if (jacobian == nullptr) {
      continue;
    }
    for (std::size_t k = 0; k < coordinates_.size(); ++k) {
      const LogCoordinate& c = coordinates_[k];
      const double at = coordinates(static_cast<Eigen::Index>(k));
      double value = 0.0;
      if (c.parameter == 0) {
        value = shares[c.process * rows + row] / sum;
      } else {
        const std::size_t parameters = model[c.process].parameters.size();
        value = gradient[c.process][row * parameters + c.parameter] * model[c.process].parameters[c.parameter] / sum;
      }
      slope(j, static_cast<Eigen::Index>(k)) = at >= c.low && at <= c.high ? -value : 0.0;
    }
  }
  Eigen::VectorXd whitened = curve_->whitening * raw;
  const double squared = whitened.squaredNorm();
  if (jacobian != nullptr) {
    *jacobian = curve_->whitening * slope;
  }
  if (residual != nullptr) {
    *residual = std::move(whitened);
  }
  return squared;
}

double LogFit::minimise(Eigen::VectorXd& at, std::optional<std::size_t> fixed) const {
  std::vector<Eigen::Index> free;
  for (std::size_t k = 0; k < coordinates_.size(); ++k) {
    if (!fixed || *fixed != k) {
      free.push_back(static_cast<Eigen::Index>(k));
    }
  }
  if (free.empty()) {
    return evaluate(at, nullptr, nullptr);
  }
  const auto full = [&](const Eigen::VectorXd& values) {
    Eigen::VectorXd point = at;
    point(free) = values;
    return point;
  };
  const auto residual = [&](const Eigen::VectorXd& values, Eigen::VectorXd& residuals, Eigen::MatrixXd* jacobian) {
    Eigen::MatrixXd all;
    evaluate(full(values), &residuals, jacobian != nullptr ? &all : nullptr);
    if (jacobian != nullptr) {
      *jacobian = all(Eigen::all, free);
    }
  };
  Eigen::VectorXd values = at(free);
  levenberg_marquardt(residual, scales(),
                      {.max_iterations = 80,
                       .gradient_tolerance = 1e-9,
                       .parameter_tolerance = 1e-9,
                       .function_tolerance = 1e-7,
                       .cost_threshold = 1e-14,
                       .first_trust_radius = 1e2},
                      values);
  at = full(values);
  for (std::size_t k = 0; k < coordinates_.size(); ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    at(i) = std::clamp(at(i), coordinates_[k].low, coordinates_[k].high);
  }
  return evaluate(at, nullptr, nullptr);
}

bool LogFit::improve(Eigen::VectorXd start) {
  const double value = minimise(start, std::nullopt);
  if (!(value < minimum_)) {
    return false;
  }
  best_ = std::move(start);
  minimum_ = value;
  return true;
}

bool LogFit::converged() const {
  Eigen::VectorXd residual;
  Eigen::MatrixXd jacobian;
  evaluate(best_, &residual, &jacobian);
  return (jacobian * least_squares(jacobian, residual)).squaredNorm() <= 1e-6 * std::max(1.0, minimum_);
}

Eigen::VectorXd LogFit::residual() const {
  const Model model = this->model();
  Eigen::VectorXd residual = curve_->curve.log_variance;
  for (Eigen::Index j = 0; j < residual.size(); ++j) {
    const auto row = static_cast<std::size_t>(curve_->curve.used[static_cast<std::size_t>(j)]);
    residual(j) -= std::log(haar_variance(model, moments_.half[row], moments_.dt_at(row)));
  }
  return residual;
}

Eigen::VectorXd LogFit::sandwich(const BlockDiagonal& scatter) const {
  Eigen::MatrixXd whitened_slope;
  evaluate(best_, nullptr, &whitened_slope);
  return sandwich_covariance(whitened_slope, curve_->whitening.around(scatter)).diagonal().cwiseSqrt();
}

double LogFit::constrained(std::size_t k, double value, Eigen::VectorXd& warm) const {
  const auto index = static_cast<Eigen::Index>(k);
  Eigen::VectorXd from_best = best_;
  from_best(index) = value;
  const double from_best_value = minimise(from_best, k);
  warm(index) = value;
  const double warm_value = minimise(warm, k);
  if (from_best_value < warm_value) {
    warm = from_best;
    return from_best_value;
  }
  return warm_value;
}

double LogFit::rise_at(std::size_t k, double value) {
  Eigen::VectorXd warm = best_;
  const double found = constrained(k, value, warm);
  if (found < minimum_) {
    best_ = std::move(warm);
    minimum_ = found;
  }
  return found - minimum_;
}

double LogFit::condition_number() const {
  Eigen::MatrixXd jacobian;
  evaluate(best_, nullptr, &jacobian);
  const Eigen::VectorXd singular = singular_values(jacobian);
  const double least = singular(singular.size() - 1);
  return jacobian.rows() >= jacobian.cols() && least > 1e-14 * singular(0) ? singular(0) / least : kInfinity;
}

std::vector<std::size_t> LogFit::at_bound() const {
  std::vector<std::size_t> bounds;
  for (std::size_t k = 0; k < coordinates_.size(); ++k) {
    const double at = best_(static_cast<Eigen::Index>(k));
    if (at <= coordinates_[k].low + 1e-6 || at >= coordinates_[k].high - 1e-6) {
      bounds.push_back(k);
    }
  }
  return bounds;
}

Interval LogFit::profile(std::size_t k, double rise) {
  const auto index = static_cast<Eigen::Index>(k);
  const double guess = std::clamp(1.96 * sandwich()(index), 1e-4, 1.0);
  Interval interval{-kInfinity, kInfinity};
  for (const double direction : {-1.0, 1.0}) {
    const double limit = direction < 0.0 ? coordinates_[k].low : coordinates_[k].high;
    double inside = best_(index);
    double outside = inside;
    double inside_value = 0.0;
    double outside_value = 0.0;
    Eigen::VectorXd warm = best_;
    bool found = false;
    for (double step = guess; !found; step *= 1.6) {  // outwards until L has risen enough, or the range ends
      outside = direction < 0.0 ? std::max(limit, inside - step) : std::min(limit, inside + step);
      outside_value = constrained(k, outside, warm) - minimum_;
      if (outside_value < -1e-4 && restarts_ < kMaxRestarts) {  // better than the best known: start again from it
        ++restarts_;
        best_ = warm;
        minimum_ += outside_value;
        return profile(k, rise);
      }
      found = outside_value > rise;
      if (!found) {
        inside = outside;
        inside_value = outside_value;
        if (outside == limit) {
          break;
        }
      }
    }
    if (!found) {
      continue;
    }
    for (int i = 0; i < 25 && std::fabs(outside - inside) > 2e-4 * std::max(guess, std::fabs(outside - best_(index)));
         ++i) {
      // Regula falsi on sqrt(L), which is nearly linear in the coordinate, kept away from the ends.
      const double root = std::sqrt(std::max(rise, 0.0));
      const double a = std::sqrt(std::max(inside_value, 0.0));
      const double b = std::sqrt(outside_value);
      const double fraction = std::clamp((root - a) / std::max(b - a, 1e-12), 0.1, 0.9);
      const double middle = inside + fraction * (outside - inside);
      warm(index) = middle;  // between two known points: the nearer of them is start enough
      const double value = minimise(warm, k) - minimum_;
      if (value > rise) {
        outside = middle;
        outside_value = value;
      } else {
        inside = middle;
        inside_value = value;
      }
      if (std::fabs(value - rise) < 1e-3 * rise) {
        outside = inside = middle;
      }
    }
    (direction < 0.0 ? interval.low : interval.high) = 0.5 * (inside + outside);
  }
  return interval;
}

}  // namespace driftlab
