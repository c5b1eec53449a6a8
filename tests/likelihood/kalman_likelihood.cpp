#include "tests/likelihood/kalman_likelihood.hpp"

#include <Eigen/Dense>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

namespace driftlab {
namespace {

/// Readings, the constant column and the drift column go through one filter together: they have the same gain.
using Lanes = Eigen::Array4d;
constexpr Eigen::Index kReading = 0;
constexpr Eigen::Index kConstant = 1;
constexpr Eigen::Index kDrift = 2;

constexpr std::size_t kPollEvery = 65536;
/// The gain is taken for settled when `kSettleSteps` steps change it by less than this.
constexpr double kSettled = 5e-13;
constexpr std::size_t kSettleSteps = 64;

/// The processes' state spaces side by side; phi as its non-zero entries.
struct Stacked {
  struct Entry {
    Eigen::Index row;
    Eigen::Index column;
    double value;
  };
  Eigen::MatrixXd phi;
  std::vector<Entry> entries;
  Eigen::MatrixXd q;
  Eigen::RowVectorXd h;
  Eigen::MatrixXd cov0;
  double r = 0.0;
  bool drifts = false;
  double relative_error = 0.0;
};

void append(Stacked& all, const StateSpace& part) {
  const Eigen::Index old = all.phi.rows();
  const Eigen::Index more = part.phi.rows();
  const auto grow = [&](Eigen::MatrixXd& matrix, const Eigen::MatrixXd& block) {
    matrix.conservativeResize(old + more, old + more);
    matrix.rightCols(more).setZero();
    matrix.bottomRows(more).setZero();
    matrix.bottomRightCorner(more, more) = block;
  };
  grow(all.phi, part.phi);
  grow(all.q, part.q);
  grow(all.cov0, part.cov0);
  all.h.conservativeResize(old + more);
  all.h.tail(more) = part.h;
  all.r += part.r;
  all.relative_error = std::max(all.relative_error, part.relative_error);
}

Result<Stacked> stack(const Model& model, double dt_s) {
  if (model.empty() || !(dt_s > 0.0) || !std::isfinite(dt_s)) {
    return fail(ErrorCode::InvalidArgument, "A likelihood needs a model and a positive sample interval.");
  }
  Stacked all;
  for (const Process& process : model) {
    if (process.kind->symbol == "DR") {
      all.drifts = true;
      continue;
    }
    const std::optional<StateSpace> part = process.state_space(dt_s);
    if (!part) {
      return fail(ErrorCode::InvalidArgument, "The " + std::string(process.kind->title) + " has no state space.",
                  {{"process", std::string(process.kind->name)}});
    }
    append(all, *part);
  }
  for (Eigen::Index i = 0; i < all.phi.rows(); ++i) {
    for (Eigen::Index j = 0; j < all.phi.cols(); ++j) {
      if (all.phi(i, j) != 0.0) {
        all.entries.push_back({i, j, all.phi(i, j)});
      }
    }
  }
  return all;
}

/// One-step predictor: the state's mean for each lane, its covariance, and what the innovations add up to.
class Filter {
 public:
  Filter(const Stacked& space, std::size_t samples, double dt_s)
      : space_(space),
        middle_(0.5 * static_cast<double>(samples - 1)),
        dt_s_(dt_s),
        state_(static_cast<std::size_t>(space.phi.rows()), Lanes::Zero()),
        next_(state_),
        covariance_(space.cov0),
        gain_(Eigen::VectorXd::Zero(space.phi.rows())),
        old_gain_(gain_) {}

  /// False where the innovation variance is not a positive number.
  bool run(std::span<const double> samples, double pivot, std::size_t first) {
    for (std::size_t t = 0; t < samples.size(); ++t) {
      const bool missing = std::isnan(samples[t]);
      if (!settled_ || missing) {
        if (!step_covariance(missing)) {
          return false;
        }
      }
      Lanes reading;
      const double time = (static_cast<double>(first + t) - middle_) * dt_s_;
      reading << samples[t] - pivot, 1.0, time, 0.0;
      step_state(reading, missing);
    }
    return true;
  }

  [[nodiscard]] std::size_t used() const { return used_; }
  [[nodiscard]] double log_det() const { return log_det_ + static_cast<double>(settled_count_) * std::log(variance_); }
  [[nodiscard]] const std::array<Lanes, 3>& products() const { return products_; }

 private:
  /// gain = phi P h'/S, P <- phi P phi' + Q - gain S gain'.
  bool step_covariance(bool missing) {
    if (settled_count_ > 0) {  // their logarithms belong to the variance that held
      log_det_ += static_cast<double>(settled_count_) * std::log(variance_);
      settled_count_ = 0;
    }
    settled_ = false;
    const Eigen::Index n = covariance_.rows();
    Eigen::VectorXd loading = n > 0 ? Eigen::VectorXd(covariance_ * space_.h.transpose()) : Eigen::VectorXd();
    const double variance = space_.r + (n > 0 ? space_.h.dot(loading) : 0.0);
    if (!(variance > 0.0) || !std::isfinite(variance)) {
      return false;
    }
    moved_.setZero(n, n);
    for (const Stacked::Entry& entry : space_.entries) {
      moved_.row(entry.row) += entry.value * covariance_.row(entry.column);
    }
    covariance_ = space_.q;
    for (const Stacked::Entry& entry : space_.entries) {
      covariance_.col(entry.row) += entry.value * moved_.col(entry.column);
    }
    if (missing) {
      steps_ = 0;
      return true;
    }
    variance_ = variance;
    gain_.setZero();
    for (const Stacked::Entry& entry : space_.entries) {
      gain_(entry.row) += entry.value * loading(entry.column) / variance;
    }
    covariance_.noalias() -= variance * gain_ * gain_.transpose();
    watch();
    return true;
  }

  void watch() {
    if (++steps_ % kSettleSteps != 0) {
      return;
    }
    const double size = n_largest(gain_);
    const double change = gain_.size() > 0 ? (gain_ - old_gain_).cwiseAbs().maxCoeff() : 0.0;
    settled_ = steps_ > kSettleSteps && std::fabs(variance_ - old_variance_) <= kSettled * variance_ &&
               change <= kSettled * size;
    old_gain_ = gain_;
    old_variance_ = variance_;
  }
  static double n_largest(const Eigen::VectorXd& v) { return v.size() > 0 ? v.cwiseAbs().maxCoeff() : 0.0; }

  void step_state(const Lanes& reading, bool missing) {
    for (Lanes& lane : next_) {
      lane.setZero();
    }
    for (const Stacked::Entry& entry : space_.entries) {
      next_[static_cast<std::size_t>(entry.row)] += entry.value * state_[static_cast<std::size_t>(entry.column)];
    }
    if (!missing) {
      Lanes innovation = reading;
      for (std::size_t k = 0; k < state_.size(); ++k) {
        innovation -= space_.h(static_cast<Eigen::Index>(k)) * state_[k];
      }
      for (std::size_t k = 0; k < next_.size(); ++k) {
        next_[k] += gain_(static_cast<Eigen::Index>(k)) * innovation;
      }
      const Lanes weighted = innovation / variance_;
      products_[0] += innovation[kReading] * weighted;
      products_[1] += innovation[kConstant] * weighted;
      products_[2] += innovation[kDrift] * weighted;
      ++used_;
      if (settled_) {
        ++settled_count_;
      } else {
        log_det_ += std::log(variance_);
      }
    }
    state_.swap(next_);
  }

  const Stacked& space_;
  double middle_;
  double dt_s_;
  std::vector<Lanes> state_;
  std::vector<Lanes> next_;
  Eigen::MatrixXd covariance_;
  Eigen::MatrixXd moved_;
  Eigen::VectorXd gain_;
  Eigen::VectorXd old_gain_;
  double variance_ = 1.0;
  double old_variance_ = 0.0;
  std::size_t steps_ = 0;
  bool settled_ = false;
  std::size_t settled_count_ = 0;
  std::size_t used_ = 0;
  double log_det_ = 0.0;
  std::array<Lanes, 3> products_{Lanes::Zero(), Lanes::Zero(), Lanes::Zero()};
};

/// Generalised least squares of the readings on the constant and, where asked for, the drift.
KalmanLikelihood finish(const Filter& filter, const Stacked& space, double pivot) {
  const std::array<Lanes, 3>& sums = filter.products();
  const Eigen::Index columns = space.drifts ? 2 : 1;
  Eigen::Matrix2d normal = Eigen::Matrix2d::Identity();
  Eigen::Vector2d right = Eigen::Vector2d::Zero();
  for (Eigen::Index i = 0; i < columns; ++i) {
    right(i) = sums[0][1 + i];
    for (Eigen::Index k = 0; k < columns; ++k) {
      normal(i, k) = sums[static_cast<std::size_t>(1 + i)][1 + k];
    }
  }
  const Eigen::Matrix2d inverse = normal.inverse();
  const Eigen::Vector2d found = inverse * right;
  const double squares = std::max(0.0, sums[0][kReading] - right.dot(found));
  const auto n = static_cast<double>(filter.used());
  KalmanLikelihood result;
  const double constant = n * std::log(2.0 * std::numbers::pi) + filter.log_det();
  result.log_likelihood = -0.5 * (constant + squares);
  result.scale = squares / n;
  result.scaled_log_likelihood = -0.5 * (constant + n * std::log(result.scale) + n);
  result.mean = pivot + found(0);
  result.mean_sd = std::sqrt(inverse(0, 0));
  result.slope = space.drifts ? found(1) : 0.0;
  result.slope_sd = space.drifts ? std::sqrt(inverse(1, 1)) : 0.0;
  result.samples = filter.used();
  result.relative_error = space.relative_error;
  return result;
}

}  // namespace

Result<KalmanLikelihood> kalman_likelihood(std::span<const double> samples, const Model& model, double dt_s,
                                           const RunControl& control) {
  const Result<Stacked> space = stack(model, dt_s);
  if (!space) {
    return fail(space.error());
  }
  const auto first = std::find_if(samples.begin(), samples.end(), [](double value) { return !std::isnan(value); });
  const double pivot = first != samples.end() ? *first : 0.0;
  Filter filter(*space, std::max<std::size_t>(samples.size(), 1), dt_s);
  for (std::size_t start = 0; start < samples.size(); start += kPollEvery) {
    if (control.stop.stop_requested()) {
      return fail(ErrorCode::Cancelled, "The likelihood was cancelled.");
    }
    const std::size_t count = std::min(kPollEvery, samples.size() - start);
    if (!filter.run(samples.subspan(start, count), pivot, start)) {
      return fail(ErrorCode::OutOfRange,
                  "The model predicts a sample without error, or its variances overflow: it has no likelihood.");
    }
  }
  if (filter.used() < 3) {
    return fail(ErrorCode::TooFewSamples, "A likelihood needs at least 3 samples that are not missing.");
  }
  const KalmanLikelihood result = finish(filter, *space, pivot);
  if (!std::isfinite(result.log_likelihood)) {
    return fail(ErrorCode::OutOfRange, "The likelihood is not a finite number.");
  }
  return result;
}

double bayesian_criterion(double log_likelihood, std::size_t parameters, std::size_t samples) {
  return -2.0 * log_likelihood + static_cast<double>(parameters) * std::log(static_cast<double>(samples));
}

}  // namespace driftlab
