#include "core/navigate/drive/filter_run.hpp"

#include "core/navigate/drive/fix_gate.hpp"
#include "core/navigate/drive/measurement_equations.hpp"
#include "core/navigate/drive/smoother.hpp"
#include "core/signal/angle.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace driftlab::drive {
namespace {

constexpr double kHeadingKnown = 1.0 * kDegree;  // spec/drives.md, section 3
constexpr double kRestSeconds = 1.0;             // the same
constexpr double kTurnWindow = 0.05;             ///< [s] on each side; chosen, not measured
constexpr std::size_t kTapedReadings = 9;        ///< at most: the filter itself closes a step after ten
constexpr double kTapedPoints = 0.08;            ///< [s] at least between two points; chosen, not measured
constexpr double kTapedStep = 0.1;               ///< [s] at most, or one reading

enum class Step { Score, Begin, Along, Position, Velocity, Odometer };  // in this order at one moment
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
        design_(design),
        done_(start.reading),
        mean_s_(velocity_mean_s(options)),
        position_gate_(options.gate, options.gate_memory),
        velocity_gate_(options.gate, options.gate_memory) {
    if (task.vibration != nullptr && (options.gyro_vibration > 0.0 || options.force_vibration > 0.0)) {
      vibration_ = task.vibration;
      for (std::size_t c = 0; c < kImuChannels; ++c) {
        // The design holds what does not follow the vibration.
        shaken_[c] = shaken_over_even(options, c) * white_square_of(design.settings().imu.axes[c]);
      }
    }
    constraint_step_ =
        options.constraint
            ? std::max<std::size_t>(
                  1, static_cast<std::size_t>(std::lround(1.0 / (options.constraint->rate_hz * run_.dt_s))))
            : 0;
    turn_window_ = std::max<std::size_t>(1, static_cast<std::size_t>(std::lround(kTurnWindow / run_.dt_s)));
    mean_window_ = static_cast<std::size_t>(std::lround(0.5 * mean_s_ / run_.dt_s));
    rest_step_ = std::max<std::size_t>(2, static_cast<std::size_t>(std::lround(kRestSeconds / run_.dt_s)));
    taped_step_ = std::clamp<std::size_t>(static_cast<std::size_t>(kTapedStep / run_.dt_s + 1e-9), 1, kTapedReadings);
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

  [[nodiscard]] std::vector<FilterEvent> events(double from_s) const {
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
      const double at_s = drive_.odometer[i].time_s;
      const bool slips = std::any_of(options_.slips.begin(), options_.slips.end(),
                                     [&](const auto& slip) { return at_s >= slip[0] && at_s <= slip[1]; });
      if (!slips) {
        add(own(at_s), Step::Odometer, i);
      }
    }
    for (std::size_t i = 0; i < task_.outages.size(); ++i) {
      add(own(task_.outages[i].start_s), Step::Begin, i);
      for (std::size_t k = 1; k < kGrowthPoints; ++k) {
        const double share = static_cast<double>(k) / static_cast<double>(kGrowthPoints);
        add(own(task_.outages[i].start_s + share * task_.outages[i].duration_s), Step::Along, i);
      }
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
      if (vibration_ != nullptr) {
        next = std::min(next, vibration_->next_block(done_));
        shake();
      }
      if (task_.tape != nullptr) {
        next = std::min(next, done_ + taped_step_);
      }
      filter_.advance(readings_.subspan(done_, next - done_));
      done_ = next;
      if (task_.tape != nullptr) {
        keep_step();
      }
      if (options_.constraint && done_ % constraint_step_ == 0) {
        const std::array<double, 2> slip = task_.slip != nullptr ? (*task_.slip)(done_) : std::array<double, 2>{};
        measure(MeasurementKind::Constraint, now(),
                [&](const FilterMoment& at) { return constraint_equations(at, *at.options.constraint, slip); });
      }
      if (options_.zero_velocity && done_ % rest_step_ == 0) {
        hold_still();
      }
    }
  }

  void keep_step() {
    task_.tape->step(filter_.pending_transition());
    const Eigen::MatrixXd covariance = filter_.covariance().dense();
    if (now() - task_.tape->last_point_s() > kTapedPoints) {
      task_.tape->point(now(), filter_.state(), covariance);
    }
  }

  /// The noise of the block that begins or goes on here.
  void shake() {
    std::array<double, kImuChannels> extra = vibration_->at(done_);
    for (std::size_t c = 0; c < kImuChannels; ++c) {
      extra[c] *= shaken_[c];
    }
    filter_.set_extra_noise(extra);
  }

  void take(const FilterEvent& event) {
    switch (event.step) {
      case Step::Score:
        score(event.index);
        return;
      case Step::Begin:
        begun_ = {now(), filter_.state()};
        return;
      case Step::Along:
        note_error();
        return;
      case Step::Position:
        measure(
            MeasurementKind::Position, event.time_s,
            [&](const FilterMoment& at) {
              return position_equations(at, drive_.fixes[event.index], late(event.time_s));
            },
            &position_gate_);
        if (task_.keep_poses) {
          pose();
        }
        return;
      case Step::Velocity:
        if (const Fix& fix = drive_.fixes[event.index]; fix.velocity_ned_m_s) {
          measure(
              MeasurementKind::Velocity, event.time_s,
              [&, rate = body_rate(std::max(turn_window_, mean_window_)),
               more = more_in_mean(event.time_s)](const FilterMoment& at) {
                return velocity_equations({at.filter, at.options, rate, at.first_constant}, *fix.velocity_ned_m_s,
                                          fix.velocity_sd_m_s, late(event.time_s), more);
              },
              &velocity_gate_);
        }
        return;
      case Step::Odometer:
        if (drive_.document.odometer) {
          const OdometerReading& reading = drive_.odometer[event.index];
          measure(MeasurementKind::Odometer, reading.time_s, [&](const FilterMoment& at) {
            return odometer_equations(at, *drive_.document.odometer, reading.speed_m_s);
          });
        }
        return;
    }
  }

  /// A measurement by the options as the filter has them.
  template <class Equations>
  void measure(MeasurementKind kind, double time_s, const Equations& equations, FixGate* gate = nullptr) {
    if (options_.constants.empty()) {
      apply(kind, time_s, equations(moment(options_)), gate);
    } else {
      const FilterOptions present = at_estimates(options_, filter_, design_.first_constant());
      apply(kind, time_s, with_constants(moment(present), equations), gate);
    }
  }

  [[nodiscard]] FilterMoment moment(const FilterOptions& options) const {
    return {filter_, options, body_rate(turn_window_), design_.first_constant()};
  }
  /// The turning rate of the vehicle around now: the mean of `half` readings on each side, less what the filter
  /// believes to be the gyroscope's error. They last a tenth of a second at least, for vibration on a long arm is no
  /// velocity that a receiver sees.
  [[nodiscard]] Vector3 body_rate(std::size_t half) const {
    const std::size_t first = done_ > half ? done_ - half : 0;
    const std::size_t last = std::min(done_ + half, readings_.size());
    Vector3 mean = Vector3::Zero();
    for (std::size_t i = first; i < last; ++i) {
      mean += Vector3(readings_[i][0], readings_[i][1], readings_[i][2]);
    }
    mean /= static_cast<double>(last - first);
    Vector3 error = Vector3::Zero();
    if (done_ > 0) {  // a fix may come before the first reading
      const ImuSample& newest = readings_[done_ - 1];
      error = Vector3(newest[0], newest[1], newest[2]) - filter_.last_rate();
    }
    return mean - error - filter_.attitude().transpose() * earth_rate();
  }

  /// By how much the mean velocity over T = velocity_mean_s differs from that in its middle `time_s`, in body axes at
  /// that moment: 1/T times the double integral of the force f, in which gravity cancels. After u seconds the force is
  /// (I + u [w x]) f in those axes. Zero where readings do not reach.
  [[nodiscard]] Vector3 more_in_mean(double time_s) const {
    Vector3 more = Vector3::Zero();
    const double half = 0.5 * mean_s_;
    const double middle = time_s - run_.start_s;
    const double last = static_cast<double>(readings_.size()) * run_.dt_s;
    if (!(half > 0.0) || middle - half < 0.0 || middle + half > last) {
      return more;
    }
    const Vector3 rate = body_rate(turn_window_);
    // The weight of the acceleration at u is (half - |u|)/T with the sign of u; this is its integral from -half to u.
    const auto weight_until = [&](double u) {
      const double left = std::max(half - std::abs(u), 0.0);
      return -0.5 * left * left / mean_s_;
    };
    const auto first = static_cast<std::size_t>((middle - half) / run_.dt_s);
    const auto end = std::min(static_cast<std::size_t>((middle + half) / run_.dt_s) + 1, readings_.size());
    for (std::size_t i = first; i < end; ++i) {
      const double from = static_cast<double>(i) * run_.dt_s - middle;
      const double weight = weight_until(from + run_.dt_s) - weight_until(from);
      const Vector3 force(readings_[i][3], readings_[i][4], readings_[i][5]);
      more += weight * (force + (from + 0.5 * run_.dt_s) * rate.cross(force));
    }
    return more;
  }

  /// How long ago a moment was, for the filter.
  [[nodiscard]] double late(double time_s) const { return options_.date_to_sample ? 0.0 : now() - time_s; }

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
    if (!steady(rate[0] - rate[1], force[0] - force[1])) {
      return;
    }
    apply(MeasurementKind::ZeroVelocity, now(), rest_equations(moment(options_)));
    if (moves_along_its_nose(drive_.document.vehicle)) {  // an aircraft or a boat at rest may turn with the wind
      const double mean = 0.5 * (rate[0].z() + rate[1].z());
      apply(MeasurementKind::ZeroTurn, now(),
            no_turn_equations(moment(options_), design_, mean, 2.0 * static_cast<double>(half) * run_.dt_s));
    }
  }

  /// Gate, update, record.
  void apply(MeasurementKind kind, double time_s, std::span<const WideMeasurement> measurements,
             FixGate* gate = nullptr) {
    Innovation record;
    record.time_s = time_s + options_.imu_offset_s;
    record.kind = kind;
    record.count = static_cast<int>(measurements.size());
    if (gate != nullptr && options_.gate > 0.0) {
      const ErrorCovariance& covariance = filter_.covariance();
      double worst = 0.0;
      for (std::size_t i = 0; i < measurements.size(); ++i) {
        record.scalar[i] = covariance.expected(measurements[i], ErrorCovariance::State::Zero());
        worst = std::max(worst, record.scalar[i].value * record.scalar[i].value / record.scalar[i].variance);
      }
      record.accepted = gate->accepts(worst);
      result_.rejected += record.accepted ? 0 : 1;
    }
    if (record.accepted && task_.tape != nullptr) {
      task_.tape->measured(filter_.covariance().dense(), measurements);
    }
    if (record.accepted) {
      filter_.measure(measurements, std::span(record.scalar).first(measurements.size()));
    }
    if (task_.keep_innovations) {
      result_.innovations.push_back(record);
    }
    const bool of_fix = kind == MeasurementKind::Position || kind == MeasurementKind::Velocity;
    if (of_fix && !result_.heading_known_s) {
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

  [[nodiscard]] OutageMoment outage_moment() const {
    const bool known = options_.constants.empty();
    return {now(), filter_.state(), filter_.attitude(),
            known ? options_.lever_arm_m : at_estimates(options_, filter_, design_.first_constant()).lever_arm_m};
  }

  /// Of the state alone: asked for its covariance, the filter would end a step here.
  void note_error() {
    const auto error = antenna_error(drive_, options_, outage_moment());
    begun_.growth_m.push_back(error ? error->head<2>().norm() : std::numeric_limits<double>::quiet_NaN());
  }

  void score(std::size_t index) {
    const OutageEnd end{outage_moment(), filter_.covariance().navigation(), heading_sd()};
    if (auto scored = score_outage(drive_, options_, task_.outages[index], begun_, end)) {
      scored->phase = task_.phase;
      result_.outages.push_back(std::move(*scored));
    }
  }

  const Drive& drive_;
  const UniformRun& run_;
  std::span<const ImuSample> readings_;
  const FilterOptions& options_;
  const FilterTask& task_;
  NavigationFilter filter_;
  const FilterDesign& design_;
  std::size_t done_;
  const Vibration* vibration_ = nullptr;
  std::array<double, kImuChannels> shaken_{};  ///< squared density of the noise that follows the vibration, on average
  std::size_t constraint_step_ = 0;
  std::size_t rest_step_ = 100;
  std::size_t turn_window_ = 5;  ///< readings on each side
  double mean_s_ = 0.0;          ///< velocity_mean_s of the options
  std::size_t mean_window_ = 0;  ///< half of it, in readings
  std::size_t taped_step_ = kTapedReadings;
  FixGate position_gate_, velocity_gate_;
  OutageStart begun_;
  FilterRun result_;
};

}  // namespace

Result<FilterDesign> make_design(const Document& document, double dt_s, const Start& start,
                                 const FilterOptions& options) {
  FilterSettings settings;
  settings.imu = document.model;
  for (std::size_t c = 0; c < kImuChannels; ++c) {
    scale_white_noise(settings.imu.axes[c], even_noise_factor(options, c) * noise_after_correction(options.errors, c));
  }
  settings.initial = start.uncertainty;
  Constants constants = constants_of(options);
  settings.constants_sd = std::move(constants.sd);
  settings.constants_tau_s = std::move(constants.tau_s);
  return FilterDesign::make(settings, dt_s);
}

FilterRun run_filter(const Drive& drive, const Start& start, std::span<const ImuSample> readings,
                     const FilterDesign& design, const FilterOptions& options, const FilterTask& task) {
  return Driver(drive, start, readings, design, options, task).go(start.time_s);
}

}  // namespace driftlab::drive
