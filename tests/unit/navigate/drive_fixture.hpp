#pragma once
/// A simulated drive as `load_drive` would give it, with errors that a test puts in.
#include "core/navigate/drive/explain.hpp"
#include "core/navigate/imu_simulator.hpp"
#include "core/navigate/segment_motion.hpp"
#include "core/process/registry.hpp"
#include "core/signal/angle.hpp"

#include <gtest/gtest.h>

namespace driftlab::drive {

/// What is put into the simulated drive and the filter is not told.
struct Hidden {
  double imu_offset_s = 0.0;  ///< the unit's stamps must be shifted by this
  double velocity_latency_s = 0.0;
  double velocity_mean_s = 0.0;  ///< velocities are means over this time, around the moment that they describe
  Vector3 lever_arm_m = Vector3::Zero();
  ReadingErrors errors = {};
  double noise_factor = 1.0;        ///< of the gyroscope's white noise
  double force_noise_factor = 1.0;  ///< of the accelerometer's
  Vector3 unit_m =
      Vector3::Zero();     ///< from the point that moves along the nose to the unit; the antenna is at the unit
  double rate_hz = 100.0;  ///< of the unit
};

inline ImuModel unit_model(double factor = 1.0, double force_factor = 1.0) {
  ImuModel model;
  for (std::size_t c = 0; c < kImuChannels; ++c) {
    const bool gyro = c < 3;
    model.axes[c].bias_sd = gyro ? 0.1 * kDegree : 0.05;
    model.axes[c].processes =
        ModelSchedule::constant({*make_process("white_noise", {gyro ? 0.02 * kDegree * factor : 2e-3 * force_factor}),
                                 *make_process("random_walk", {gyro ? 2e-5 : 2e-4})});
  }
  return model;
}

/// Starts, stops and turns both ways, for `laps` times 100 s.
inline SegmentPlan town_plan(int laps) {
  SegmentPlan plan;
  plan.start = {48.0 * kDegree, 9.0 * kDegree, 300.0};
  plan.duration_s = 20.0 + 100.0 * laps;
  const auto add = [&](Segment segment) { plan.segments.push_back(segment); };
  for (int lap = 0; lap < laps; ++lap) {
    const double t = 20.0 + 100.0 * lap;
    const double sign = lap % 2 == 0 ? 1.0 : -1.0;
    add({SegmentKind::Accelerate, t, 0.0, 0.0, 2.0, 14.0});
    add({SegmentKind::Turn, t + 12.0, 8.0, sign * 12.0 * kDegree, 0.0, 0.0});
    add({SegmentKind::SCurve, t + 26.0, 5.0, 15.0 * kDegree, 0.0, 0.0});
    add({SegmentKind::Accelerate, t + 40.0, 0.0, 0.0, 1.5, 6.0});
    add({SegmentKind::Turn, t + 50.0, 9.0, -sign * 10.0 * kDegree, 0.0, 0.0});
    add({SegmentKind::Accelerate, t + 62.0, 0.0, 0.0, 2.0, 16.0});
    add({SegmentKind::Turn, t + 72.0, 6.0, sign * 15.0 * kDegree, 0.0, 0.0});
    add({SegmentKind::Stop, t + 84.0, 0.0, 0.0, 2.5, 0.0});
  }
  return plan;
}

/// Readings of the force at a point `arm` away from where `ideal` has them: f + w' x r + w x (w x r).
inline void move_unit(std::vector<ImuSample>& ideal, double dt_s, const Vector3& arm) {
  const auto rate_of = [](const ImuSample& sample) { return Vector3(sample[0], sample[1], sample[2]); };
  const std::vector<ImuSample> at_point = ideal;
  for (std::size_t i = 0; i < ideal.size(); ++i) {
    const std::size_t before = i == 0 ? 0 : i - 1;
    const std::size_t after = std::min(i + 1, ideal.size() - 1);
    const Vector3 rate = rate_of(at_point[i]);
    const Vector3 change =
        (rate_of(at_point[after]) - rate_of(at_point[before])) / (static_cast<double>(after - before) * dt_s);
    const Vector3 more = change.cross(arm) + rate.cross(rate.cross(arm));
    for (std::size_t c = 0; c < 3; ++c) {
      ideal[i][c + 3] += more(static_cast<Eigen::Index>(c));
    }
  }
}

/// Readings (100 Hz where nothing else is asked) and 4 Hz fixes of 2 cm and 5 cm/s between two samples each. The
/// document believes `unit_model()`.
inline Drive simulated_drive(std::uint64_t seed, const Hidden& hidden = {}, int laps = 4) {
  const auto motion = make_segment_motion(town_plan(laps));
  EXPECT_TRUE(motion) << motion.error().message;
  const auto truth = make_trajectory(**motion, hidden.rate_hz);
  EXPECT_TRUE(truth);
  Drive drive;
  drive.document.id = "simulated";
  drive.document.model = unit_model();
  std::vector<ImuSample> ideal = truth->imu;
  move_unit(ideal, truth->dt_s, hidden.unit_m);
  const Vector3 antenna_m = hidden.unit_m + hidden.lever_arm_m;
  for (ImuSample& sample : ideal) {
    const Vector3 rate(sample[0], sample[1], sample[2]);
    const Vector3 force(sample[3], sample[4], sample[5]);
    const Vector3 read_rate = rate + hidden.errors.gyroscope * rate;
    const Vector3 read_force = force + hidden.errors.accelerometer * force;
    sample = {read_rate.x(), read_rate.y(), read_rate.z(), read_force.x(), read_force.y(), read_force.z()};
  }
  UniformRun run{
      0.0, truth->dt_s,
      simulate_imu(ideal, truth->dt_s, unit_model(hidden.noise_factor, hidden.force_noise_factor), {}, seed, 0)
          .readings};
  run.start_s = -hidden.imu_offset_s;
  drive.runs.push_back(std::move(run));
  Random noise(seed, 77);
  const auto at = [&](double time_s) {
    const double place = std::clamp(time_s / truth->dt_s, 0.0, static_cast<double>(truth->imu.size() - 1));
    const auto i = static_cast<std::size_t>(place);
    const NavigationState& state = truth->states[i];
    const Vector3 rate =
        Vector3(truth->imu[i][0], truth->imu[i][1], truth->imu[i][2]) - state.attitude.conjugate() * earth_rate();
    const double step = time_s - static_cast<double>(i) * truth->dt_s;
    const Vector3 acceleration = (truth->states[i + 1].velocity_ecef_m_s - state.velocity_ecef_m_s) / truth->dt_s;
    struct {
      Vector3 position, velocity;
    } antenna{state.position_ecef_m + step * state.velocity_ecef_m_s + 0.5 * step * step * acceleration +
                  state.attitude * (rotation(step * rate) * antenna_m),
              state.velocity_ecef_m_s + step * acceleration + state.attitude * rate.cross(antenna_m)};
    return antenna;
  };
  const auto velocity_around = [&](double time_s) {
    constexpr int kParts = 50;
    Vector3 mean = Vector3::Zero();
    for (int part = 0; part < kParts; ++part) {
      const double share = (part + 0.5) / kParts - 0.5;
      mean += at(time_s + share * hidden.velocity_mean_s).velocity / kParts;
    }
    return hidden.velocity_mean_s > 0.0 ? mean : at(time_s).velocity;
  };
  for (int k = 2; k * 0.25 + 0.5 < 20.0 + 100.0 * laps; ++k) {
    Fix fix;
    fix.time_s = 0.25 * k + 0.0037;  // never on a sample
    const auto antenna = at(fix.time_s);
    const Matrix3 axes = ned_axes(antenna.position);
    fix.position_sd_m = {0.02, 0.02, 0.03};
    fix.velocity_sd_m_s = {0.05, 0.05, 0.05};
    const Vector3 error(noise.normal(), noise.normal(), noise.normal());
    const Vector3 of_velocity(noise.normal(), noise.normal(), noise.normal());
    fix.position_ecef_m = antenna.position + axes * fix.position_sd_m.cwiseProduct(error);
    fix.velocity_ned_m_s = axes.transpose() * velocity_around(fix.time_s - hidden.velocity_latency_s) +
                           fix.velocity_sd_m_s.cwiseProduct(of_velocity);
    fix.has_course = fix.velocity_ned_m_s->head<2>().norm() > 0.5;
    drive.fixes.push_back(fix);
    drive.reference.push_back({fix.time_s, fix.position_ecef_m});
  }
  drive.withheld_fixes = true;
  return drive;
}

}  // namespace driftlab::drive
