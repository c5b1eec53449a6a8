#include "core/navigate/recorded_motion.hpp"

#include "core/signal/turns.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

namespace driftlab {
namespace {

/// Natural cubic spline through (x, y): value and slope.
class Spline {
 public:
  Spline(const std::vector<double>& x, std::vector<double> y) : y_(std::move(y)), bend_(y_.size(), 0.0) {
    // The second derivatives solve a tridiagonal system; Thomas's algorithm.
    const std::size_t count = y_.size();
    std::vector<double> upper(count, 0.0);
    for (std::size_t i = 1; i + 1 < count; ++i) {
      const double before = x[i] - x[i - 1];
      const double after = x[i + 1] - x[i];
      const double pivot = 2.0 * (before + after) - before * upper[i - 1];
      const double jump = (y_[i + 1] - y_[i]) / after - (y_[i] - y_[i - 1]) / before;
      upper[i] = after / pivot;
      bend_[i] = (6.0 * jump - before * bend_[i - 1]) / pivot;
    }
    for (std::size_t i = count - 1; i-- > 1;) {
      bend_[i] -= upper[i] * bend_[i + 1];
    }
  }

  /// Within the panel from i to i + 1 of width h, at fraction u.
  [[nodiscard]] std::pair<double, double> at(std::size_t i, double h, double u) const {
    const double w = 1.0 - u;
    const double value =
        w * y_[i] + u * y_[i + 1] + h * h / 6.0 * ((w * w * w - w) * bend_[i] + (u * u * u - u) * bend_[i + 1]);
    const double slope =
        (y_[i + 1] - y_[i]) / h + h / 6.0 * ((1.0 - 3.0 * w * w) * bend_[i] + (3.0 * u * u - 1.0) * bend_[i + 1]);
    return {value, slope};
  }

 private:
  std::vector<double> y_;
  std::vector<double> bend_;
};

constexpr std::size_t kCurves = 6;

std::array<double, kCurves> numbers_of(const RecordedPose& pose) {
  return {pose.velocity_ned_m_s.x(), pose.velocity_ned_m_s.y(), pose.velocity_ned_m_s.z(),
          pose.attitude.roll_rad,    pose.attitude.pitch_rad,   pose.attitude.heading_rad};
}

class RecordedMotion final : public Motion {
 public:
  RecordedMotion(const Geodetic& start, const std::vector<RecordedPose>& poses) : start_(start) {
    for (const RecordedPose& pose : poses) {
      time_.push_back(pose.time_s - poses.front().time_s);
    }
    for (std::size_t k = 0; k < kCurves; ++k) {
      std::vector<double> y;
      for (const RecordedPose& pose : poses) {
        double value = numbers_of(pose)[k];
        if (k >= 3 && !y.empty()) {
          value = nearest_turn(value, y.back());
        }
        y.push_back(value);
      }
      curves_.emplace_back(time_, std::move(y));
    }
  }

  [[nodiscard]] Geodetic start() const override { return start_; }
  [[nodiscard]] double duration_s() const override { return time_.back(); }

  [[nodiscard]] MotionState at(double time_s) const override {
    const auto next = std::upper_bound(time_.begin() + 1, time_.end() - 1, time_s);
    const auto i = static_cast<std::size_t>(next - time_.begin()) - 1;
    const double h = time_[i + 1] - time_[i];
    const double u = (time_s - time_[i]) / h;
    std::array<std::pair<double, double>, kCurves> x;
    for (std::size_t k = 0; k < kCurves; ++k) {
      x[k] = curves_[k].at(i, h, u);
    }
    MotionState state;
    state.velocity_ned_m_s = {x[0].first, x[1].first, x[2].first};
    state.acceleration_ned_m_s2 = {x[0].second, x[1].second, x[2].second};
    state.attitude = {x[3].first, x[4].first, x[5].first};
    state.attitude_rate = {x[3].second, x[4].second, x[5].second};
    return state;
  }

 private:
  Geodetic start_;
  std::vector<double> time_;
  std::vector<Spline> curves_;
};

}  // namespace

Result<std::unique_ptr<Motion>> make_recorded_motion(const Geodetic& start, const std::vector<RecordedPose>& poses) {
  if (poses.size() < 4) {
    return fail(ErrorCode::TooFewSamples, "A recorded trajectory needs at least 4 poses.");
  }
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const auto values = numbers_of(poses[i]);
    if (!std::isfinite(poses[i].time_s) ||
        !std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); })) {
      return fail(ErrorCode::NonFinite, "The recorded trajectory holds a number that is not finite.",
                  {{"row", std::to_string(i)}});
    }
    if (i > 0 && !(poses[i].time_s > poses[i - 1].time_s)) {
      return fail(ErrorCode::NonMonotonicTime, "The times of the recorded trajectory do not increase.",
                  {{"row", std::to_string(i)}});
    }
  }
  return std::make_unique<RecordedMotion>(start, poses);
}

}  // namespace driftlab
