#pragma once
/// Every cause of drives put into simulated drives, by code that knows nothing of the filter's options: what a search
/// must find again. A cause without an injection here fails the laws of drive_cause_laws_test.cpp.
#include "core/navigate/earth.hpp"
#include "core/process/random.hpp"
#include "tests/unit/navigate/drive_fixture.hpp"

#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

namespace driftlab::drive {

struct DriveInjection {
  std::string cause, parameter;
  double clear = 0.0;     ///< a size that must be named, SI
  double reported = 0.0;  ///< what the finding then says, in its unit
  double within = 0.0;    ///< of `reported`, in its unit
  bool constraint = false;
  std::string beside = {};  ///< a cause that is there too
  std::function<Drive(std::uint64_t seed, double size, int laps)> drive;
  double nothing = 0.0;  ///< the size that hides nothing, SI
};

/// Every reading turned by C, as a unit reads that is mounted otherwise than the document says.
inline void turn_readings(Drive& drive, const Matrix3& c) {
  for (ImuSample& sample : drive.runs.front().readings) {
    const Vector3 rate = c * Vector3(sample[0], sample[1], sample[2]);
    const Vector3 force = c * Vector3(sample[3], sample[4], sample[5]);
    sample = {rate.x(), rate.y(), rate.z(), force.x(), force.y(), force.z()};
  }
}

/// Gauss-Markov errors of positions, one and a half times as large down as north and east.
inline Drive with_lasting_errors(std::uint64_t seed, double sigma_m, double tau_s, int laps) {
  Drive drive = simulated_drive(seed, {}, laps);
  Random random(seed, 6);
  Vector3 error = Vector3::Zero();
  double before = -1e9;
  for (std::size_t i = 0; i < drive.fixes.size(); ++i) {
    Fix& fix = drive.fixes[i];
    const double phi = std::exp(-(fix.time_s - before) / tau_s);
    before = fix.time_s;
    for (Eigen::Index k = 0; k < 3; ++k) {
      const double sd = sigma_m * (k == 2 ? 1.5 : 1.0);
      error(k) = phi * error(k) + sd * std::sqrt(1.0 - phi * phi) * random.normal();
    }
    fix.position_ecef_m += ned_axes(fix.position_ecef_m) * error;
    drive.reference[i].position_ecef_m = fix.position_ecef_m;
  }
  return drive;
}

/// A third of the time the unit is shaken at 20 Hz, which moves nothing, and one sensor's noise is larger there: what
/// follows the vibration is `ratio` times the rest on the whole drive.
inline Drive shaken_drive(std::uint64_t seed, double ratio, int laps, std::size_t first_channel) {
  Drive drive = simulated_drive(seed, {}, laps);
  Random random(seed, 5);
  UniformRun& run = drive.runs.front();
  const bool gyroscope = first_channel == 0;
  const double density = gyroscope ? 0.02 * kDegree : 2e-3;
  const double shake = gyroscope ? 2.0 * kDegree : 0.3;
  for (std::size_t i = 0; i < run.readings.size(); ++i) {
    const double time_s = static_cast<double>(i) * run.dt_s;
    for (std::size_t c = first_channel; c < first_channel + 3 && std::fmod(time_s, 60.0) > 40.0; ++c) {
      run.readings[i][c] += shake * std::sin(2.0 * std::numbers::pi * 20.0 * time_s) +
                            std::sqrt(3.0 * ratio) * density / std::sqrt(run.dt_s) * random.normal();
    }
  }
  return drive;
}

/// Velocities are means over a second times the root of `share`, half a second old in their middle, as the document
/// says.
inline Drive with_mean_velocities(std::uint64_t seed, double share, int laps) {
  constexpr double kLate = 0.3;  // [s]
  Hidden hidden;
  hidden.velocity_latency_s = kLate;
  hidden.velocity_mean_s = 2.0 * kLate * std::sqrt(share);
  Drive drive = simulated_drive(seed, hidden, laps);
  drive.document.gnss.velocity_latency_s = kLate;
  return drive;
}

/// An odometer at 4 Hz that reads `scale` too much and slips for three seconds where `slip_m_s` is not 0.
inline Drive with_odometer(std::uint64_t seed, double scale, double slip_m_s, int laps) {
  Drive drive = simulated_drive(seed, {}, laps);
  drive.document.odometer.emplace();
  Random random(seed, 8);
  for (const Fix& fix : drive.fixes) {
    const bool slips = fix.time_s > 140.0 && fix.time_s < 143.0;
    drive.odometer.push_back({fix.time_s, (1.0 + scale) * fix.velocity_ned_m_s->head<2>().norm() +
                                              (slips ? slip_m_s : 0.0) + 0.02 * random.normal()});
  }
  return drive;
}

/// The heading of the document is `error` less than that of the vehicle.
inline Drive with_stated_heading(std::uint64_t seed, double error, int laps) {
  Drive drive = simulated_drive(seed, {}, laps);
  const auto course = find_start(drive, 0);
  EXPECT_TRUE(course);
  const Matrix3 axes = ned_axes(course->state.position_ecef_m);
  drive.document.start.heading_rad =
      to_euler(Quaternion(axes).conjugate() * course->state.attitude).heading_rad - error;
  return drive;
}

/// A unit that samples at `rate_hz` and is asked at 100 Hz: the host writes the newest reading that is ready.
inline Drive polled_drive(std::uint64_t seed, double rate_hz, int laps) {
  Hidden hidden;
  hidden.rate_hz = rate_hz;
  Drive drive = simulated_drive(seed, hidden, laps);
  const UniformRun own = std::move(drive.runs.front());
  SensorLog log;
  for (double time_s = 0.05; time_s < own.end_s(); time_s += 0.01) {
    log.time_s.push_back(time_s);
    log.readings.push_back(own.readings[static_cast<std::size_t>(time_s / own.dt_s) - 1]);
  }
  auto runs = uniform_readings(std::move(log), {SensorClock::Host, true}, drive.facts.sampling);
  EXPECT_TRUE(runs);
  drive.runs = std::move(*runs);
  return drive;
}

inline std::vector<DriveInjection> drive_injections() {
  const auto hide = [](auto put) {
    return [put](std::uint64_t seed, double size, int laps) {
      Hidden hidden;
      put(hidden, size);
      return simulated_drive(seed, hidden, laps);
    };
  };
  const auto turned = [](const Vector3& axis) {
    return [axis](std::uint64_t seed, double size, int laps) {
      Drive drive = simulated_drive(seed, {}, laps);
      turn_readings(drive, Eigen::AngleAxisd(size, axis).toRotationMatrix());
      return drive;
    };
  };
  return {
      // The newest reading is half a sample old on average.
      {"sample_clock", "rate_hz", 97.9, 97.9, 0.02, false, "imu_time_offset", polled_drive, 100.0},
      {"imu_time_offset", "delta_s", 0.05, 0.05, 0.01, false, "",
       hide([](Hidden& h, double size) { h.imu_offset_s = size; })},
      {"gnss_velocity_latency", "delay_s", 0.1, 0.1, 0.02, false, "",
       hide([](Hidden& h, double size) { h.velocity_latency_s = size; })},
      {"gnss_velocity_averaging", "share", 1.0, 100.0, 30.0, false, "", with_mean_velocities},
      {"gnss_lever_arm", "x", 0.8, 0.8, 0.1, false, "", hide([](Hidden& h, double size) { h.lever_arm_m.x() = size; })},
      {"gnss_lever_arm", "y", -0.8, -0.8, 0.1, false, "",
       hide([](Hidden& h, double size) { h.lever_arm_m.y() = size; })},
      {"gyro_scale_factor_error", "z", 0.02, 2.0, 0.5, false, "",
       hide([](Hidden& h, double size) { h.errors.gyroscope(2, 2) = size; })},
      {"gyro_axis_misalignment", "xz", 0.02, 2.0, 0.5, false, "",
       hide([](Hidden& h, double size) { h.errors.gyroscope(0, 2) = size; })},
      {"accelerometer_scale_factor_error", "x", 0.05, 5.0, 1.0, false, "",
       hide([](Hidden& h, double size) { h.errors.accelerometer(0, 0) = size; })},
      {"mounting_angles", "yaw", 2.0 * kDegree, 2.0, 0.3, true, "", turned(Vector3::UnitZ())},
      {"mounting_angles", "pitch", -2.0 * kDegree, -2.0, 0.3, true, "", turned(Vector3::UnitY())},
      {"mounting_angles", "axle", -1.5, -1.5, 0.2, true, "",
       hide([](Hidden& h, double size) { h.unit_m.x() = -size; })},
      {"vibration_noise", "gyroscope", 5.0 / 6.0, 500.0 / 6.0, 15.0, false, "noise_level",
       [](std::uint64_t seed, double size, int laps) { return shaken_drive(seed, size / (1.0 - size), laps, 0); }},
      // The fixes show an accelerometer's noise weakly: the search states +- 25 %, and ends at 99.9 under Clang.
      {"vibration_noise", "accelerometer", 5.0 / 6.0, 500.0 / 6.0, 25.0, false, "noise_level",
       [](std::uint64_t seed, double size, int laps) { return shaken_drive(seed, size / (1.0 - size), laps, 3); }},
      {"noise_level", "gyroscope", 4.0, 4.0, 1.0, false, "",
       hide([](Hidden& h, double size) { h.noise_factor = size; }), 1.0},
      {"noise_level", "accelerometer", 6.0, 6.0, 1.5, false, "",
       hide([](Hidden& h, double size) { h.force_noise_factor = size; }), 1.0},
      {"gnss_coloured_noise", "sigma", 0.5, 0.5, 0.25, false, "",
       [](std::uint64_t seed, double size, int laps) { return with_lasting_errors(seed, size, 20.0, laps); }},
      {"odometer_scale", "S", 0.03, 3.0, 0.5, false, "",
       [](std::uint64_t seed, double size, int laps) { return with_odometer(seed, size, 0.0, laps); }},
      {"wheel_slip", "seconds", 2.0, 3.6, 0.5, false, "",
       [](std::uint64_t seed, double size, int laps) { return with_odometer(seed, 0.0, size, laps); }},
      {"initial_heading", "heading", 40.0 * kDegree, 40.0, 8.0, false, "", with_stated_heading},
  };
}

}  // namespace driftlab::drive
