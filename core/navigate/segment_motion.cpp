#include "core/navigate/segment_motion.hpp"

#include <array>
#include <cmath>
#include <string>

namespace driftlab {
namespace {

constexpr std::array kNames{std::string_view("straight"), std::string_view("turn"), std::string_view("accelerate"),
                            std::string_view("s_curve"), std::string_view("stop")};

/// Smoothstep and its integral: 0 before 0, and u - 1/2 for the integral beyond 1.
double step(double u) { return u <= 0.0 ? 0.0 : (u >= 1.0 ? 1.0 : u * u * (3.0 - 2.0 * u)); }
double step_integral(double u) { return u <= 0.0 ? 0.0 : (u >= 1.0 ? u - 0.5 : u * u * u * (1.0 - 0.5 * u)); }

struct Pulse {
  double start_s = 0.0;
  double duration_s = 0.0;
  double value = 0.0;
};

class SegmentMotion final : public Motion {
 public:
  explicit SegmentMotion(const SegmentPlan& plan) : plan_(plan) {
    double speed = plan.speed_m_s;
    for (const Segment& segment : plan.segments) {
      add(segment, speed);
    }
  }

  [[nodiscard]] Geodetic start() const override { return plan_.start; }
  [[nodiscard]] double duration_s() const override { return plan_.duration_s; }

  [[nodiscard]] MotionState at(double time_s) const override {
    const auto [turned, rate] = sum(turns_, time_s);
    const auto [gained, acceleration] = sum(speeds_, time_s);
    const double heading = plan_.heading_rad + turned;
    const double speed = plan_.speed_m_s + gained;
    const double c = std::cos(heading);
    const double s = std::sin(heading);
    MotionState state;
    state.velocity_ned_m_s = {speed * c, speed * s, 0.0};
    state.acceleration_ned_m_s2 = {acceleration * c - speed * rate * s, acceleration * s + speed * rate * c, 0.0};
    state.attitude.heading_rad = heading;
    state.attitude_rate.heading_rad = rate;
    return state;
  }

 private:
  void add(const Segment& segment, double& speed) {
    switch (segment.kind) {
      case SegmentKind::Straight:
        return;
      case SegmentKind::Turn:
        turns_.push_back({segment.start_s, segment.duration_s, segment.rate_rad_s});
        return;
      case SegmentKind::SCurve:
        turns_.push_back({segment.start_s, segment.duration_s, segment.rate_rad_s});
        turns_.push_back({segment.start_s + segment.duration_s, segment.duration_s, -segment.rate_rad_s});
        return;
      case SegmentKind::Accelerate:
      case SegmentKind::Stop: {
        const double target = segment.kind == SegmentKind::Stop ? 0.0 : segment.until_speed_m_s;
        const double change = target - speed;
        speed = target;
        if (change != 0.0) {
          const double magnitude = std::fabs(segment.acceleration_m_s2);
          speeds_.push_back({segment.start_s, std::fabs(change) / magnitude, std::copysign(magnitude, change)});
        }
        return;
      }
    }
  }

  /// Integral from the beginning, and value now.
  [[nodiscard]] std::pair<double, double> sum(const std::vector<Pulse>& pulses, double time_s) const {
    double integral = 0.0;
    double value = 0.0;
    for (const Pulse& pulse : pulses) {
      const double up = (time_s - pulse.start_s) / plan_.ramp_s;
      if (up <= 0.0) {
        continue;
      }
      const double down = (time_s - pulse.start_s - pulse.duration_s) / plan_.ramp_s;
      if (down >= 1.0) {
        integral += pulse.value * pulse.duration_s;
        continue;
      }
      integral += pulse.value * plan_.ramp_s * (step_integral(up) - step_integral(down));
      value += pulse.value * (step(up) - step(down));
    }
    return {integral, value};
  }

  SegmentPlan plan_;
  std::vector<Pulse> turns_;
  std::vector<Pulse> speeds_;
};

tl::unexpected<Error> bad(std::size_t index, const std::string& why) {
  return fail(ErrorCode::InvalidArgument,
              "The segment " + std::to_string(index + 1) + " of the trajectory " + why + ".",
              {{"segment", std::to_string(index)}});
}

Status check(const SegmentPlan& plan, std::size_t index) {
  const Segment& segment = plan.segments[index];
  const double before = index == 0 ? 0.0 : plan.segments[index - 1].start_s;
  if (!(segment.start_s >= before && segment.start_s <= plan.duration_s)) {
    return bad(index, "does not start after the one before it and within the trajectory");
  }
  const bool turns = segment.kind == SegmentKind::Turn || segment.kind == SegmentKind::SCurve;
  if (turns && !(segment.duration_s > 0.0 && std::isfinite(segment.rate_rad_s) && std::isfinite(segment.duration_s))) {
    return bad(index, "needs a finite rate and a duration above 0");
  }
  const bool changes = segment.kind == SegmentKind::Accelerate || segment.kind == SegmentKind::Stop;
  if (changes && !(std::fabs(segment.acceleration_m_s2) > 0.0 && std::isfinite(segment.acceleration_m_s2))) {
    return bad(index, "needs an acceleration other than 0");
  }
  if (!(segment.duration_s >= 0.0)) {
    return bad(index, "has a duration below 0");
  }
  if (!(segment.until_speed_m_s >= 0.0 && std::isfinite(segment.until_speed_m_s))) {
    return bad(index, "has a target speed below 0");
  }
  return {};
}

/// A change of speed that begins before the one before it has ended would leave its target and may drive backwards.
Status check_speeds(const SegmentPlan& plan) {
  double speed = plan.speed_m_s;
  double free_from = 0.0;
  for (std::size_t i = 0; i < plan.segments.size(); ++i) {
    const Segment& segment = plan.segments[i];
    if (segment.kind != SegmentKind::Accelerate && segment.kind != SegmentKind::Stop) {
      continue;
    }
    const double target = segment.kind == SegmentKind::Stop ? 0.0 : segment.until_speed_m_s;
    if (target == speed) {
      continue;
    }
    if (segment.start_s < free_from - 1e-9) {
      return bad(i, "changes the speed before the change before it has ended");
    }
    free_from = segment.start_s + std::fabs((target - speed) / segment.acceleration_m_s2) + plan.ramp_s;
    speed = target;
  }
  return {};
}

}  // namespace

std::string_view name_of(SegmentKind kind) { return kNames[static_cast<std::size_t>(kind)]; }

Result<SegmentKind> parse_segment_kind(std::string_view name) {
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    if (kNames[i] == name) {
      return static_cast<SegmentKind>(i);
    }
  }
  return fail(ErrorCode::InvalidArgument,
              "A segment is straight, turn, accelerate, s_curve or stop, not '" + std::string(name) + "'.",
              {{"parameter", "kind"}, {"value", std::string(name)}});
}

Result<std::unique_ptr<Motion>> make_segment_motion(const SegmentPlan& plan) {
  if (!(plan.duration_s > 0.0 && std::isfinite(plan.duration_s) && plan.ramp_s > 0.0 && plan.speed_m_s >= 0.0)) {
    return fail(ErrorCode::InvalidArgument,
                "A trajectory needs a duration and a ramp above 0 and a speed that is not negative.");
  }
  for (std::size_t i = 0; i < plan.segments.size(); ++i) {
    if (auto status = check(plan, i); !status) {
      return fail(status.error());
    }
  }
  if (auto status = check_speeds(plan); !status) {
    return fail(status.error());
  }
  return std::make_unique<SegmentMotion>(plan);
}

}  // namespace driftlab
