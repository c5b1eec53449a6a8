#include "core/navigate/drive/filter_run.hpp"

#include "core/signal/angle.hpp"

#include <algorithm>
#include <cmath>

namespace driftlab::drive {
namespace {

constexpr double kNearestReference = 1.6;  ///< [s]
constexpr int kRejectedInARow = 5;         ///< after so many the receiver is believed again
constexpr int kMostBelieved = 60;
constexpr double kRestSpeed = 0.5;         ///< [m/s]
constexpr double kRestSd = 0.02;           ///< [m/s]
constexpr double kRestTurnSd = 0.05 * kDegree;
constexpr double kSteadyRestRate = 0.6 * kDegree;
constexpr double kSteadyRestForce = 0.2;  ///< [m/s^2]
constexpr double kTurnWindow = 0.05;      ///< [s] on each side
constexpr double kHeadingKnown = 1.0 * kDegree;

/// Where the constants that a filter estimates stand behind the sensor states.
struct ConstantLayout {
  int arm = -1, yaw = -1, axle = -1, odometer = -1;
};

std::vector<double> constants_of(const EstimatedConstants& constants, ConstantLayout& layout, int first) {
  std::vector<double> sd;
  const auto add = [&](const std::optional<double>& value, int count, int& at) {
    if (value) {
      at = first + static_cast<int>(sd.size());
      sd.insert(sd.end(), static_cast<std::size_t>(count), *value);
    }
  };
  add(constants.lever_arm_sd_m, 3, layout.arm);
  add(constants.mounting_sd_rad, 2, layout.yaw);
  add(constants.axle_sd_m, 1, layout.axle);
  add(constants.odometer_scale_sd, 1, layout.odometer);
  return sd;
}

enum class Step { Score, Begin, Position, Velocity, Odometer };  // in this order at one moment
struct FilterEvent {
  double time_s = 0.0;  ///< on the unit's clock
  Step step = Step::Position;
  std::size_t index = 0;
};

/// One filter on its way through a drive.
class Driver {
 public:
  Driver(const Drive& drive, const Start& start, std::span<const ImuSample> readings, const FilterDesign& design,
         const FilterOptions& options, const FilterTask& task)
      : drive_(drive),
        run_(drive.runs[start.run]),
        readings_(readings),
        options_(options),
        task_(task),
        filter_(design, start.state),
        done_(start.reading) {
    (void)constants_of(options.constants, layout_, design.first_constant());
    constraint_step_ =
        options.constraint
            ? std::max<std::size_t>(
                  1, static_cast<std::size_t>(std::lround(1.0 / (options.constraint->rate_hz * run_.dt_s))))
            : 0;
    turn_window_ = std::max<std::size_t>(1, static_cast<std::size_t>(std::lround(kTurnWindow / run_.dt_s)));
    rest_step_ = std::max<std::size_t>(2, static_cast<std::size_t>(std::lround(1.0 / run_.dt_s)));
  }

  FilterRun go(double from_s) {
    for (const FilterEvent& event : events(from_s)) {
      const double local = (event.time_s - run_.start_s) / run_.dt_s;
      const auto reading = static_cast<std::size_t>(std::max(std::ceil(local - 1e-9), 0.0));
      if (reading > readings_.size()) {
        break;
      }
      advance_to(reading);
      take(event);
    }
    return std::move(result_);
  }

 private:
  [[nodiscard]] double now() const { return run_.start_s + static_cast<double>(done_) * run_.dt_s; }
  /// From the drive's clock to the unit's.
  [[nodiscard]] double own(double time_s) const { return time_s - options_.imu_offset_s; }
  [[nodiscard]] bool withheld(double stamp_s, double described_s) const {
    return std::any_of(task_.outages.begin(), task_.outages.end(),
                       [&](const Outage& outage) { return outage.covers(stamp_s) || outage.covers(described_s); });
  }

  std::vector<FilterEvent> events(double from_s) const {
    std::vector<FilterEvent> list;
    list.reserve(2 * drive_.fixes.size());
    const auto add = [&](double time_s, Step step, std::size_t index) {
      if (time_s > from_s) {
        list.push_back({time_s, step, index});
      }
    };
    for (std::size_t i = 0; i < drive_.fixes.size(); ++i) {
      const Fix& fix = drive_.fixes[i];
      const double of_position = fix.time_s - options_.position_latency_s;
      const double of_velocity = fix.time_s - options_.velocity_latency_s;
      if (!withheld(fix.time_s, of_position)) {
        add(own(of_position), Step::Position, i);
      }
      if (fix.velocity_ned_m_s && !withheld(fix.time_s, of_velocity)) {
        add(own(of_velocity), Step::Velocity, i);
      }
    }
    for (std::size_t i = 0; options_.odometer && i < drive_.odometer.size(); ++i) {
      add(own(drive_.odometer[i].time_s), Step::Odometer, i);
    }
    for (std::size_t i = 0; i < task_.outages.size(); ++i) {
      add(own(task_.outages[i].start_s), Step::Begin, i);
      add(own(task_.outages[i].end_s()), Step::Score, i);
    }
    std::sort(list.begin(), list.end(), [](const FilterEvent& a, const FilterEvent& b) {
      return a.time_s != b.time_s ? a.time_s < b.time_s : a.step != b.step ? a.step < b.step : a.index < b.index;
    });
    return list;
  }

  void advance_to(std::size_t reading) {
    while (done_ < reading) {
      std::size_t next = reading;
      if (constraint_step_ > 0) {
        next = std::min(next, (done_ / constraint_step_ + 1) * constraint_step_);
      }
      if (options_.zero_velocity) {
        next = std::min(next, (done_ / rest_step_ + 1) * rest_step_);
      }
      filter_.advance(readings_.subspan(done_, next - done_));
      done_ = next;
      if (constraint_step_ > 0 && done_ % constraint_step_ == 0) {
        constrain();
      }
      if (options_.zero_velocity && done_ % rest_step_ == 0) {
        hold_still();
      }
    }
  }

  void take(const FilterEvent& event) {
    switch (event.step) {
      case Step::Score:
        score(event.index);
        return;
      case Step::Begin:
        begun_ = filter_.state();
        begun_s_ = now();
        return;
      case Step::Position:
        position(drive_.fixes[event.index], event.time_s);
        return;
      case Step::Velocity:
        velocity(drive_.fixes[event.index], event.time_s);
        return;
      case Step::Odometer:
        odometer(drive_.odometer[event.index]);
        return;
    }
  }

  [[nodiscard]] double constant(int at) const { return at < 0 ? 0.0 : filter_.sensor_states()(at); }
  [[nodiscard]] Vector3 arm() const {
    return options_.lever_arm_m + Vector3(constant(layout_.arm), constant(layout_.arm < 0 ? -1 : layout_.arm + 1),
                                          constant(layout_.arm < 0 ? -1 : layout_.arm + 2));
  }
  /// The turning rate of the vehicle around now: the mean of a tenth of a second, for vibration on a long arm is no
  /// velocity that a receiver sees, less what the filter believes to be the gyroscope's error.
  [[nodiscard]] Vector3 body_rate() const {
    const std::size_t half = turn_window_;
    const std::size_t first = done_ > half ? done_ - half : 0;
    const std::size_t last = std::min(done_ + half, readings_.size());
    Vector3 mean = Vector3::Zero();
    for (std::size_t i = first; i < last; ++i) {
      mean += Vector3(readings_[i][0], readings_[i][1], readings_[i][2]);
    }
    mean /= static_cast<double>(last - first);
    const ImuSample& newest = readings_[done_ - 1];
    const Vector3 error = Vector3(newest[0], newest[1], newest[2]) - filter_.last_rate();
    return mean - error - filter_.attitude().transpose() * earth_rate();
  }

  void position(const Fix& fix, double time_s) {
    const double late = options_.date_to_sample ? 0.0 : now() - time_s;
    const NavigationState& state = filter_.state();
    const Matrix3& attitude = filter_.attitude();
    const Matrix3 axes = ned_axes(state.position_ecef_m);
    const Vector3 own_arm = arm();
    const Vector3 turned = attitude * own_arm;
    const Vector3 arm_velocity = attitude * body_rate().cross(own_arm);
    const Vector3 antenna = state.position_ecef_m + turned - late * (state.velocity_ecef_m_s + arm_velocity) +
                            (0.5 * late * late) * filter_.last_acceleration();
    const Vector3 gap = fix.position_ecef_m - antenna;
    std::array<WideMeasurement, 3> measurements;
    for (Eigen::Index k = 0; k < 3; ++k) {
      const Vector3 axis = axes.col(k);
      WideMeasurement& m = measurements[static_cast<std::size_t>(k)];
      m.navigation.h << axis, -late * axis, turned.cross(axis);
      m.navigation.innovation = axis.dot(gap);
      m.navigation.variance = fix.position_sd_m(k) * fix.position_sd_m(k);
      add_arm(m, attitude.transpose() * axis);
    }
    apply(MeasurementKind::Position, time_s, measurements, true);
    if (task_.keep_poses) {
      pose();
    }
  }

  void velocity(const Fix& fix, double time_s) {
    const double late = options_.date_to_sample ? 0.0 : now() - time_s;
    const NavigationState& state = filter_.state();
    const Matrix3& attitude = filter_.attitude();
    const Matrix3 axes = ned_axes(state.position_ecef_m);
    const Vector3 rate = body_rate();
    const Vector3 arm_velocity = attitude * rate.cross(arm());
    const Vector3 gap =
        axes * *fix.velocity_ned_m_s - (state.velocity_ecef_m_s + arm_velocity - late * filter_.last_acceleration());
    std::array<WideMeasurement, 3> measurements;
    for (Eigen::Index k = 0; k < 3; ++k) {
      const Vector3 axis = axes.col(k);
      WideMeasurement& m = measurements[static_cast<std::size_t>(k)];
      m.navigation.h << Vector3::Zero(), axis, arm_velocity.cross(axis);
      m.navigation.innovation = axis.dot(gap);
      m.navigation.variance = fix.velocity_sd_m_s(k) * fix.velocity_sd_m_s(k);
      add_arm(m, (attitude.transpose() * axis).cross(rate));  // axis . C (w x l) = l . (C^T axis x w)
    }
    apply(MeasurementKind::Velocity, time_s, measurements, true);
  }

  void add_arm(WideMeasurement& m, const Vector3& weight) const {
    for (int k = 0; layout_.arm >= 0 && k < 3; ++k) {
      m.add(layout_.arm + k, weight(k));
    }
  }

  void constrain() {
    const Constraint& c = *options_.constraint;
    const Matrix3& attitude = filter_.attitude();
    const Vector3 v = filter_.state().velocity_ecef_m_s;
    const Vector3 body = attitude.transpose() * v;
    const Vector3 rate = body_rate();
    const double yaw = c.yaw_rad + constant(layout_.yaw);
    const double pitch = c.pitch_rad + constant(layout_.yaw < 0 ? -1 : layout_.yaw + 1);
    const double axle = c.axle_m + constant(layout_.axle);
    const std::array<double, 2> slip = task_.slip != nullptr ? (*task_.slip)(done_) : std::array<double, 2>{};
    std::array<WideMeasurement, 2> measurements;
    const Vector3 right = attitude.col(1) - yaw * attitude.col(0);
    const Vector3 down = attitude.col(2) + pitch * attitude.col(0);
    measurements[0].navigation.h << Vector3::Zero(), right, right.cross(v);
    measurements[0].navigation.innovation = slip[0] - (body.y() - yaw * body.x() + axle * rate.z());
    measurements[1].navigation.h << Vector3::Zero(), down, down.cross(v);
    measurements[1].navigation.innovation = slip[1] - (body.z() + pitch * body.x() - axle * rate.y());
    for (WideMeasurement& m : measurements) {
      m.navigation.variance = c.sd_m_s * c.sd_m_s;
    }
    if (layout_.yaw >= 0) {
      measurements[0].add(layout_.yaw, -body.x());
      measurements[1].add(layout_.yaw + 1, body.x());
    }
    if (layout_.axle >= 0) {
      measurements[0].add(layout_.axle, rate.z());
      measurements[1].add(layout_.axle, -rate.y());
    }
    apply(MeasurementKind::Constraint, now(), measurements, false);
  }

  /// Velocity 0, and no turn where the unit is on a vehicle, if the last second looks like rest and the filter says so.
  void hold_still() {
    if (done_ < rest_step_ || filter_.state().velocity_ecef_m_s.norm() >= kRestSpeed) {
      return;
    }
    std::array<Vector3, 2> rate{Vector3::Zero(), Vector3::Zero()};
    std::array<Vector3, 2> force{Vector3::Zero(), Vector3::Zero()};
    const std::size_t half = rest_step_ / 2;
    for (std::size_t i = 0; i < 2 * half; ++i) {
      const ImuSample& sample = readings_[done_ - 2 * half + i];
      rate[i / half] += Vector3(sample[0], sample[1], sample[2]) / static_cast<double>(half);
      force[i / half] += Vector3(sample[3], sample[4], sample[5]) / static_cast<double>(half);
    }
    if ((rate[0] - rate[1]).norm() > kSteadyRestRate || (force[0] - force[1]).norm() > kSteadyRestForce) {
      return;
    }
    const Matrix3 axes = ned_axes(filter_.state().position_ecef_m);
    std::array<WideMeasurement, 3> still;
    for (Eigen::Index k = 0; k < 3; ++k) {
      const Vector3 axis = axes.col(k);
      WideMeasurement& m = still[static_cast<std::size_t>(k)];
      m.navigation.h << Vector3::Zero(), axis, Vector3::Zero();
      m.navigation.innovation = -axis.dot(filter_.state().velocity_ecef_m_s);
      m.navigation.variance = kRestSd * kRestSd;
    }
    apply(MeasurementKind::ZeroVelocity, now(), still, false);
  }

  void odometer(const OdometerReading& reading) {
    const Matrix3& attitude = filter_.attitude();
    const Vector3 v = filter_.state().velocity_ecef_m_s;
    const Vector3 arm_velocity = body_rate().cross(drive_.document.odometer->lever_arm_m);
    const double speed = (attitude.transpose() * v).x() + arm_velocity.x();
    const double scale = 1.0 + options_.odometer_scale + constant(layout_.odometer);
    std::array<WideMeasurement, 1> measurement;
    WideMeasurement& m = measurement[0];
    const Vector3 forward = scale * attitude.col(0);
    m.navigation.h << Vector3::Zero(), forward, forward.cross(v);
    m.navigation.innovation = reading.speed_m_s - scale * speed;
    m.navigation.variance = drive_.document.odometer->sd_m_s * drive_.document.odometer->sd_m_s;
    if (layout_.odometer >= 0) {
      m.add(layout_.odometer, speed);
    }
    apply(MeasurementKind::Odometer, reading.time_s, measurement, false);
  }

  /// Gate, update, record.
  void apply(MeasurementKind kind, double time_s, std::span<const WideMeasurement> measurements, bool gated) {
    Innovation record;
    record.time_s = time_s + options_.imu_offset_s;
    record.kind = kind;
    record.count = static_cast<int>(measurements.size());
    if (gated && options_.gate > 0.0) {
      const ErrorCovariance& covariance = filter_.covariance();
      double worst = 0.0;
      for (std::size_t i = 0; i < measurements.size(); ++i) {
        record.scalar[i] = covariance.expected(measurements[i], ErrorCovariance::State::Zero());
        worst = std::max(worst, record.scalar[i].value * record.scalar[i].value / record.scalar[i].variance);
      }
      int& in_a_row = rejected_in_a_row_[kind == MeasurementKind::Position ? 0 : 1];
      // Once believed again, the receiver is believed until about as many fixes have agreed by themselves as disagreed.
      const bool believed = in_a_row >= kRejectedInARow;
      const bool agrees = worst <= options_.gate;
      record.accepted = agrees || believed;
      in_a_row = agrees ? (believed ? in_a_row - 1 : 0) : std::min(in_a_row + 1, kMostBelieved);
      result_.rejected += record.accepted ? 0 : 1;
    }
    if (record.accepted) {
      filter_.measure(measurements, std::span(record.scalar).first(measurements.size()));
    }
    if (task_.keep_innovations) {
      result_.innovations.push_back(record);
    }
    if (kind == MeasurementKind::Velocity && !result_.heading_known_s) {
      const double sd = heading_sd();
      if (sd < kHeadingKnown) {
        result_.heading_known_s = record.time_s;
      }
    }
  }

  [[nodiscard]] double heading_sd() {
    const Vector3 down = ned_axes(filter_.state().position_ecef_m).col(2);
    return std::sqrt(down.dot(filter_.covariance().navigation().block<3, 3>(6, 6) * down));
  }

  void pose() {
    const NavigationState& state = filter_.state();
    const Matrix3 axes = ned_axes(state.position_ecef_m);
    RecordedPose pose;
    pose.time_s = now();
    pose.velocity_ned_m_s = axes.transpose() * state.velocity_ecef_m_s;
    pose.attitude = to_euler(Quaternion(axes).conjugate() * state.attitude);
    if (result_.poses.empty() || pose.time_s > result_.poses.back().time_s) {
      result_.poses.push_back(pose);
    }
  }

  void score(std::size_t index) {
    const Outage& outage = task_.outages[index];
    const double drive_now = now() + options_.imu_offset_s;
    const auto truth = reference_at(drive_.reference, drive_now);
    const auto at_start = reference_at(drive_.reference, begun_s_ + options_.imu_offset_s);
    if (!truth || !at_start) {
      return;
    }
    DriveOutage scored;
    scored.outage = outage;
    scored.phase = task_.phase;
    scored.reference_ecef_m = *truth;
    const Matrix3 axes = ned_axes(*truth);
    const Vector3 reference_arm = drive_.withheld_fixes ? arm() : drive_.document.reference.lever_arm_m;
    const Vector3 turned = filter_.attitude() * reference_arm;
    scored.error_ned_m = axes.transpose() * (filter_.state().position_ecef_m + turned - *truth);
    Eigen::Matrix<double, 3, 9> h = Eigen::Matrix<double, 3, 9>::Zero();
    h.block<3, 3>(0, 0).setIdentity();
    h.block<3, 3>(0, 6) = -cross_matrix(turned);
    const Matrix3 p = h * filter_.covariance().navigation() * h.transpose();
    scored.covariance_ned = axes.transpose() * p * axes;
    scored.covariance_ned.diagonal() += reference_variance(drive_now);
    scored.heading_sd_rad = heading_sd();
    const Vector3 begun_arm = begun_.attitude * reference_arm;
    const Vector3 before = axes.transpose() * (begun_.position_ecef_m + begun_arm - *at_start);
    scored.start_error_m = before.head<2>().norm();
    const Vector3 straight = axes.transpose() * (begun_.position_ecef_m + begun_arm +
                                                 (now() - begun_s_) * begun_.velocity_ecef_m_s - *truth);
    scored.straight_line_error_m = straight.head<2>().norm();
    classify(scored, drive_now, axes);
    result_.outages.push_back(scored);
  }

  [[nodiscard]] Vector3 reference_variance(double time_s) const {
    const auto after = std::lower_bound(drive_.fixes.begin(), drive_.fixes.end(), time_s,
                                        [](const Fix& fix, double t) { return fix.time_s < t; });
    if (drive_.withheld_fixes && after != drive_.fixes.end()) {
      return after->position_sd_m.cwiseAbs2();
    }
    return Vector3::Constant(drive_.document.reference.sd_m * drive_.document.reference.sd_m);
  }

  /// What the vehicle does in the outage, and how the error lies to its way.
  void classify(DriveOutage& scored, double end_s, const Matrix3& axes) const {
    const auto ahead = reference_at(drive_.reference, end_s + 0.5);
    const auto behind = reference_at(drive_.reference, end_s - 0.5);
    Vector3 way = Vector3::Zero();
    if (ahead && behind) {
      way = axes.transpose() * (*ahead - *behind);
    }
    const double length = way.head<2>().norm();
    const double x = length > 0.25 ? way.x() / length : 1.0;
    const double y = length > 0.25 ? way.y() / length : 0.0;
    scored.along_m = x * scored.error_ned_m.x() + y * scored.error_ned_m.y();
    scored.across_m = x * scored.error_ned_m.y() - y * scored.error_ned_m.x();
    double longest = 0.0;
    double turned = 0.0;
    double most = 0.0;
    double before = 0.0;
    const double from = scored.outage.start_s;
    const auto seconds = static_cast<int>(scored.outage.duration_s);
    bool moving_before = false;
    for (int s = 0; s < seconds; ++s) {
      const auto a = reference_at(drive_.reference, from + s);
      const auto b = reference_at(drive_.reference, from + s + 1.0);
      if (!a || !b) {
        continue;
      }
      const Vector3 step = axes.transpose() * (*b - *a);
      const double speed = step.head<2>().norm();
      longest = std::max(longest, speed);
      if (speed > 1.0) {
        const double course = std::atan2(step.y(), step.x());
        if (moving_before) {
          turned += std::remainder(course - before, 2.0 * std::numbers::pi);
          most = std::max(most, std::abs(turned));
        }
        before = course;
        moving_before = true;
      }
    }
    scored.outage_class = longest < kRestSpeed    ? OutageClass::Rest
                          : most < 20.0 * kDegree ? OutageClass::Straight
                                                  : OutageClass::Turning;
  }

  const Drive& drive_;
  const UniformRun& run_;
  std::span<const ImuSample> readings_;
  const FilterOptions& options_;
  const FilterTask& task_;
  NavigationFilter filter_;
  std::size_t done_;
  ConstantLayout layout_;
  std::size_t constraint_step_ = 0;
  std::size_t rest_step_ = 100;
  std::size_t turn_window_ = 5;  ///< readings on each side
  std::array<int, 2> rejected_in_a_row_{};
  NavigationState begun_;
  double begun_s_ = 0.0;
  FilterRun result_;
};

}  // namespace

std::string_view name_of(OutageClass outage_class) {
  constexpr std::array<std::string_view, 3> names{"rest", "straight", "turning"};
  return names[static_cast<std::size_t>(outage_class)];
}

double DriveOutage::nees() const {
  const Matrix3& p = covariance_ned;
  const double n = error_ned_m.x();
  const double e = error_ned_m.y();
  const double cross = 0.5 * (p(0, 1) + p(1, 0));
  return (p(1, 1) * n * n - 2.0 * cross * n * e + p(0, 0) * e * e) / (p(0, 0) * p(1, 1) - cross * cross);
}

void scale_white_noise(AxisModel& axis, double factor) {
  if (factor == 1.0 || axis.processes.size() != 1) {
    return;
  }
  Model model = axis.processes.model(0);
  for (Process& process : model) {
    if (process.kind->white_square != nullptr) {
      process.parameters[0] *= factor;
    }
  }
  axis.processes = ModelSchedule::constant(std::move(model));
}

FilterOptions options_of(const Document& document) {
  FilterOptions options;
  options.lever_arm_m = document.gnss.lever_arm_m;
  options.position_latency_s = document.gnss.position_latency_s;
  options.velocity_latency_s = document.gnss.velocity_latency_s;
  return options;
}

Result<FilterDesign> make_design(const Document& document, double dt_s, const Start& start,
                                 const FilterOptions& options) {
  FilterSettings settings;
  settings.imu = document.model;
  for (std::size_t c = 0; c < kImuChannels; ++c) {
    scale_white_noise(settings.imu.axes[c], c < 3 ? options.gyro_noise : options.force_noise);
  }
  settings.initial = start.uncertainty;
  ConstantLayout layout;
  settings.constants_sd = constants_of(options.constants, layout, 0);
  return FilterDesign::make(settings, dt_s);
}

FilterRun run_filter(const Drive& drive, const Start& start, std::span<const ImuSample> readings,
                     const FilterDesign& design, const FilterOptions& options, const FilterTask& task) {
  return Driver(drive, start, readings, design, options, task).go(start.time_s);
}

std::vector<ImuSample> corrected_readings(const UniformRun& run, const ReadingErrors& errors) {
  std::vector<ImuSample> readings = run.readings;
  if (errors.none()) {
    return readings;
  }
  const Matrix3 gyroscope = (Matrix3::Identity() + errors.gyroscope).inverse();
  const Matrix3 accelerometer = (Matrix3::Identity() + errors.accelerometer).inverse();
  for (ImuSample& sample : readings) {
    const Vector3 rate = gyroscope * Vector3(sample[0], sample[1], sample[2]);
    const Vector3 force = accelerometer * Vector3(sample[3], sample[4], sample[5]);
    sample = {rate.x(), rate.y(), rate.z(), force.x(), force.y(), force.z()};
  }
  return readings;
}

std::optional<Vector3> reference_at(const std::vector<ReferencePoint>& reference, double time_s) {
  const auto after = std::lower_bound(reference.begin(), reference.end(), time_s,
                                      [](const ReferencePoint& point, double t) { return point.time_s < t; });
  if (after == reference.begin() || after == reference.end()) {
    return std::nullopt;
  }
  const auto before = after - 1;
  if (time_s - before->time_s > kNearestReference || after->time_s - time_s > kNearestReference) {
    return std::nullopt;
  }
  const double u = (time_s - before->time_s) / (after->time_s - before->time_s);
  return Vector3((1.0 - u) * before->position_ecef_m + u * after->position_ecef_m);
}

}  // namespace driftlab::drive
