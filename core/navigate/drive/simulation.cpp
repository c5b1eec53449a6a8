#include "core/navigate/drive/simulation.hpp"

#include "core/navigate/imu_simulator.hpp"
#include "core/navigate/recorded_motion.hpp"
#include "core/process/random.hpp"

#include <algorithm>
#include <cmath>

namespace driftlab::drive {
namespace {

constexpr std::uint64_t kFixStream = 8;  // the unit's channels take 0 to 5 of 16 streams a run
constexpr std::uint64_t kStartStream = 9;
constexpr std::uint64_t kSlipStream = 10;
constexpr std::uint64_t kVibrationStream = 11;
constexpr std::uint64_t kColourStream = 12;
constexpr std::uint64_t kWheelStream = 13;

/// The truth at a moment of its own clock: from the sample before with its velocity and the change of it.
NavigationState truth_at(const Trajectory& truth, double time_s) {
  const double at = std::clamp(time_s / truth.dt_s, 0.0, static_cast<double>(truth.states.size() - 1));
  const auto i = std::min(static_cast<std::size_t>(at), truth.states.size() - 2);
  const double u = at - static_cast<double>(i);
  const NavigationState& a = truth.states[i];
  const NavigationState& b = truth.states[i + 1];
  NavigationState state;
  const double step = u * truth.dt_s;
  state.velocity_ecef_m_s = (1.0 - u) * a.velocity_ecef_m_s + u * b.velocity_ecef_m_s;
  state.position_ecef_m = a.position_ecef_m + 0.5 * step * (a.velocity_ecef_m_s + state.velocity_ecef_m_s);
  state.attitude = a.attitude.slerp(u, b.attitude);
  return state;
}

Vector3 drawn(const Vector3& sd, Random& random) {
  const double north = sd.x() * random.normal();
  const double east = sd.y() * random.normal();
  return {north, east, sd.z() * random.normal()};
}

/// Errors of positions that last, moment after moment.
class LastingErrors {
 public:
  LastingErrors(const ColouredFixes& coloured, Random random) : coloured_(coloured), random_(random) {}
  Vector3 at(double time_s) {
    if (coloured_.none()) {
      return Vector3::Zero();
    }
    const double phi = begun_ ? std::exp(-(time_s - time_s_) / coloured_.tau_s) : 0.0;
    error_ = phi * error_ + drawn(std::sqrt(1.0 - phi * phi) * coloured_.sd_m(), random_);
    time_s_ = time_s;
    begun_ = true;
    return error_;
  }

 private:
  ColouredFixes coloured_;
  Random random_;
  Vector3 error_ = Vector3::Zero();
  double time_s_ = 0.0;
  bool begun_ = false;
};

constexpr std::uint64_t kSimulatedStream = 300;  ///< of the bootstrap

double mean_nees(const std::vector<DriveOutage>& outages, std::span<const std::size_t> which) {
  double sum = 0.0;
  for (const std::size_t i : which) {
    sum += outages[i].nees();
  }
  return sum / static_cast<double>(which.size());
}

double rms_error(const std::vector<DriveOutage>& outages, const std::vector<std::vector<std::size_t>>& blocks,
                 Random& random) {
  double sum = 0.0;
  double count = 0.0;
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    for (const std::size_t i : blocks[random.below(blocks.size())]) {
      sum += outages[i].error_m() * outages[i].error_m();
      count += 1.0;
    }
  }
  return std::sqrt(sum / count);
}

/// The 95 % percentile interval of the ratio of two rms errors whose blocks are resampled apart.
Interval ratio_interval(const DurationSummary& measured, const DurationSummary& simulated,
                        const std::vector<std::vector<std::size_t>>& simulated_blocks,
                        const EvaluationOptions& settings, std::uint64_t stream) {
  const auto measured_blocks = blocks_of(measured.outages, measured.period_s);
  if (measured_blocks.size() < kLeastBlocks || simulated_blocks.size() < kLeastBlocks) {
    return {};
  }
  Random random(settings.seed, stream);
  std::vector<double> ratios;
  for (int r = 0; r < settings.resamples; ++r) {
    const double above = rms_error(measured.outages, measured_blocks, random);
    ratios.push_back(above / rms_error(simulated.outages, simulated_blocks, random));
  }
  return percentile_interval(std::move(ratios));
}

}  // namespace

Result<SimulatedWorld> SimulatedWorld::make(const PreparedDrive& prepared, std::size_t part) {
  SimulatedWorld world;
  const Drive& drive = prepared.drive();
  world.recorded_ = &drive;
  world.start_ = prepared.start(part);
  world.options_ = prepared.options();
  FilterTask task;
  task.keep_poses = true;
  const FilterRun run = prepared.run(part, task);
  if (run.poses.size() < 8) {
    return fail(ErrorCode::TooFewSamples, "The drive has too few fixes to follow its trajectory.");
  }
  const double dt = drive.runs[world.start_.run].dt_s;
  world.start_s_ = run.poses.front().time_s;
  auto motion = make_recorded_motion(to_geodetic(world.start_.state.position_ecef_m), run.poses);
  if (!motion) {
    return fail(motion.error());
  }
  auto truth = make_trajectory(**motion, 1.0 / dt);
  if (!truth) {
    return fail(truth.error());
  }
  world.truth_ = std::move(*truth);
  world.believed_ = drive.document.model;
  for (std::size_t c = 0; c < kImuChannels; ++c) {
    scale_white_noise(world.believed_.axes[c], noise_after_correction(world.options_.errors, c));
  }
  world.model_ = world.believed_;
  for (std::size_t c = 0; c < kImuChannels; ++c) {
    scale_white_noise(world.model_.axes[c], even_noise_factor(world.options_, c));
  }
  world.options_.imu_offset_s = 0.0;
  world.options_.position_latency_s = 0.0;
  world.options_.velocity_latency_s = 0.0;
  world.options_.velocity_averaging = 0.0;
  world.options_.errors = {};
  world.options_.date_to_sample = false;
  world.options_.initial_heading_rad = 0.0;
  const double ahead = (world.start_s_ - drive.runs[world.start_.run].start_s) / dt;
  world.vibration_ = prepared.vibration(part).from(static_cast<std::size_t>(std::max(std::lround(ahead), 0L)));
  return world;
}

SimulatedWorld::World SimulatedWorld::draw(std::uint64_t seed, std::uint64_t run,
                                           const ReadingErrors& truth_errors) const {
  World world;
  world.drive.document = recorded_->document;
  world.drive.document.model = believed_;
  world.drive.document.gnss.lever_arm_m = options_.lever_arm_m;
  world.drive.epoch_s = recorded_->epoch_s;
  world.drive.withheld_fixes = recorded_->withheld_fixes;
  UniformRun readings{start_s_, truth_.dt_s, {}};
  std::vector<ImuSample> ideal = truth_.imu;
  if (!truth_errors.none()) {
    for (ImuSample& sample : ideal) {
      const Vector3 rate = Vector3(sample[0], sample[1], sample[2]);
      const Vector3 force = Vector3(sample[3], sample[4], sample[5]);
      const Vector3 read_rate = rate + truth_errors.gyroscope * rate;
      const Vector3 read_force = force + truth_errors.accelerometer * force;
      sample = {read_rate.x(), read_rate.y(), read_rate.z(), read_force.x(), read_force.y(), read_force.z()};
    }
  }
  readings.readings = simulate_imu(ideal, truth_.dt_s, model_, {}, seed, run).readings;
  if (options_.gyro_vibration > 0.0 || options_.force_vibration > 0.0) {
    Random shaking(seed, 16 * run + kVibrationStream);
    add_vibration_noise(vibration_, options_, model_, truth_.dt_s, shaking, readings.readings);
  }
  world.drive.runs.push_back(std::move(readings));
  Random noise(seed, 16 * run + kFixStream);
  LastingErrors lasting(options_.coloured, Random(seed, 16 * run + kColourStream));
  const double end = static_cast<double>(truth_.imu.size()) * truth_.dt_s;
  const auto rate_at = [&](double own) -> Vector3 {  // of the body against the Earth
    const auto sample = std::min(static_cast<std::size_t>(own / truth_.dt_s), truth_.imu.size() - 1);
    const ImuSample& reading = truth_.imu[sample];
    return Vector3(reading[0], reading[1], reading[2]) - truth_at(truth_, own).attitude.conjugate() * earth_rate();
  };
  for (const Fix& recorded : recorded_->fixes) {
    const double own = recorded.time_s - start_s_;
    if (own <= 0.0 || own >= end) {
      continue;
    }
    const NavigationState truth = truth_at(truth_, own);
    const Matrix3 axes = ned_axes(truth.position_ecef_m);
    Fix fix = recorded;
    fix.position_ecef_m = truth.position_ecef_m + truth.attitude * options_.lever_arm_m +
                          axes * (drawn(recorded.position_sd_m, noise) + lasting.at(own));
    const Vector3 velocity_error = drawn(recorded.velocity_sd_m_s, noise);
    if (recorded.velocity_ned_m_s) {
      const Vector3 antenna = truth.velocity_ecef_m_s + truth.attitude * rate_at(own).cross(options_.lever_arm_m);
      fix.velocity_ned_m_s = axes.transpose() * antenna + velocity_error;
    }
    world.drive.fixes.push_back(fix);
    if (world.drive.withheld_fixes) {
      world.drive.reference.push_back({fix.time_s, fix.position_ecef_m});
    }
  }
  for (std::size_t i = 0; !world.drive.withheld_fixes && i < recorded_->reference.size(); ++i) {
    const double own = recorded_->reference[i].time_s - start_s_;
    if (own > 0.0 && own < end) {
      const NavigationState truth = truth_at(truth_, own);
      world.drive.reference.push_back(
          {recorded_->reference[i].time_s,
           truth.position_ecef_m + truth.attitude * recorded_->document.reference.lever_arm_m +
               ned_axes(truth.position_ecef_m) * drawn(Vector3::Constant(recorded_->document.reference.sd_m), noise)});
    }
  }
  Random wheel(seed, 16 * run + kWheelStream);
  const OdometerSource source = recorded_->document.odometer.value_or(OdometerSource{});
  for (const OdometerReading& recorded : recorded_->odometer) {
    const double own = recorded.time_s - start_s_;
    if (own > 0.0 && own < end) {
      const NavigationState truth = truth_at(truth_, own);
      const Vector3 body = truth.attitude.conjugate() * truth.velocity_ecef_m_s;
      const double speed = (body + rate_at(own).cross(source.lever_arm_m)).x();
      world.drive.odometer.push_back(
          {recorded.time_s, (1.0 + options_.odometer_scale) * speed + source.sd_m_s * wheel.normal()});
    }
  }
  Random first(seed, 16 * run + kStartStream);
  world.start = start_;
  world.start.run = 0;
  world.start.reading = 0;
  world.start.time_s = start_s_;
  const Matrix3 axes = ned_axes(truth_.states.front().position_ecef_m);
  const InitialUncertainty& sd = start_.uncertainty;
  world.start.state = truth_.states.front();
  world.start.state.position_ecef_m += axes * drawn(sd.position_sd_m, first);
  world.start.state.velocity_ecef_m_s += axes * drawn(sd.velocity_sd_m_s, first);
  world.start.state.attitude = rotation(axes * drawn({sd.tilt_sd_rad, sd.tilt_sd_rad, sd.heading_sd_rad}, first)) *
                               truth_.states.front().attitude;
  if (options_.constraint) {
    const Constraint& c = *options_.constraint;
    Random white(seed, 16 * run + kSlipStream);
    world.slip.resize(truth_.states.size());
    const auto step = static_cast<std::size_t>(std::max(1L, std::lround(1.0 / (c.rate_hz * truth_.dt_s))));
    for (std::size_t i = step; i < truth_.states.size(); i += step) {
      const NavigationState& state = truth_.states[i];
      const Vector3 body = state.attitude.conjugate() * state.velocity_ecef_m_s;
      const ImuSample& reading = truth_.imu[i - 1];
      const Vector3 rate = Vector3(reading[0], reading[1], reading[2]) - state.attitude.conjugate() * earth_rate();
      const double right = body.y() - c.yaw_rad * body.x() + c.axle_m * rate.z();
      const double down = body.z() + c.pitch_rad * body.x() - c.axle_m * rate.y();
      const double of_right = c.sd_m_s * white.normal();
      world.slip[i] = {right + of_right, down + c.sd_m_s * white.normal()};
    }
  }
  return world;
}

Result<std::vector<SimulatedDuration>> simulate_outages(const PreparedDrive& prepared,
                                                        const std::vector<DurationSummary>& measured,
                                                        const SimulationOptions& options, const RunControl& control) {
  struct Task {
    std::size_t part, run;
  };
  std::vector<SimulatedWorld> worlds;
  std::vector<Task> tasks;
  for (std::size_t part = 0; part < prepared.parts(); ++part) {
    auto world = SimulatedWorld::make(prepared, part);
    if (!world) {
      return fail(world.error());
    }
    worlds.push_back(std::move(*world));
    for (int run = 0; run < options.runs; ++run) {
      tasks.push_back({part, static_cast<std::size_t>(run)});
    }
  }
  std::vector<std::vector<std::vector<DriveOutage>>> scored(tasks.size());
  parallel_for(
      control.threads, tasks.size(),
      [&](std::size_t i) {
        const SimulatedWorld& world = worlds[tasks[i].part];
        const SimulatedWorld::World drawn_world = world.draw(options.seed, tasks[i].run);
        const auto design =
            make_design(drawn_world.drive.document, world.truth().dt_s, drawn_world.start, world.options());
        const SideSlip slip = [&](std::size_t reading) { return drawn_world.slip[reading]; };
        scored[i].resize(drawn_world.drive.document.outages.duration_s.size());
        for (const PlannedRun& planned :
             plan_outages(prepared.drive(), prepared.start(tasks[i].part))) {  // the outages that were measured
          FilterTask task;
          task.outages = planned.outages;
          task.phase = planned.phase;
          task.slip = drawn_world.slip.empty() ? nullptr : &slip;
          task.vibration = &world.vibration();
          const FilterRun run = run_filter(drawn_world.drive, drawn_world.start, drawn_world.drive.runs[0].readings,
                                           *design, world.options(), task);
          auto& list = scored[i][planned.duration];
          list.insert(list.end(), run.outages.begin(), run.outages.end());
        }
      },
      control.stop);
  if (control.stop.stop_requested()) {
    return fail(ErrorCode::Cancelled, "The simulation was cancelled.");
  }
  std::vector<SimulatedDuration> results;
  const OutagePlan& plan = prepared.drive().document.outages;
  for (const DurationSummary& own : measured) {
    const auto d = static_cast<std::size_t>(std::find(plan.duration_s.begin(), plan.duration_s.end(), own.duration_s) -
                                            plan.duration_s.begin());
    std::vector<DriveOutage> all;
    std::vector<std::vector<std::size_t>> blocks;
    for (const auto& one : scored) {
      for (auto& block : blocks_of(one[d], own.period_s)) {
        std::for_each(block.begin(), block.end(), [&](std::size_t& i) { i += all.size(); });
        blocks.push_back(std::move(block));
      }
      all.insert(all.end(), one[d].begin(), one[d].end());
    }
    if (all.empty()) {
      continue;
    }
    EvaluationOptions no_bootstrap;
    no_bootstrap.resamples = 0;
    const DurationSummary summary = summarise(std::move(all), own.duration_s, own.period_s, no_bootstrap);
    SimulatedDuration result;
    result.duration_s = own.duration_s;
    result.count = summary.outages.size();
    result.rms_m = summary.rms_m.value;
    result.mean_m = summary.mean_m;
    result.median_m = summary.median_m.value;
    result.growth = summary.growth;
    const EvaluationOptions bootstrap{.seed = options.seed};
    const auto share = [&](double fraction, std::uint64_t stream) {
      return share_inside(summary.outages, blocks, fraction, bootstrap, stream);
    };
    result.nees = {summary.nees.value,
                   bootstrap_interval(
                       blocks, [&](std::span<const std::size_t> which) { return mean_nees(summary.outages, which); },
                       bootstrap, kSimulatedStream)};
    result.coverage50 = share(0.5, kSimulatedStream + 1);
    result.coverage95 = share(0.95, kSimulatedStream + 2);
    result.ratio = {own.rms_m.value / result.rms_m,
                    ratio_interval(own, summary, blocks, bootstrap, kSimulatedStream + 3)};
    results.push_back(result);
  }
  return results;
}

}  // namespace driftlab::drive
