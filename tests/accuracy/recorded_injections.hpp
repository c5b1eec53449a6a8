#pragma once
/// Every cause of drives put into a recorded drive, by code that knows nothing of the filter's knobs. Where the
/// recording shows the cause already (repeats, vibration, levels) more of it is put on top, and the change is what must
/// be named.
#include "core/navigate/attitude.hpp"
#include "core/navigate/drive/explain.hpp"
#include "core/process/random.hpp"
#include "core/signal/angle.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <numbers>
#include <optional>
#include <vector>

namespace driftlab::accuracy {

using drive::Drive;
using drive::FilterOptions;
using drive::Fix;

/// The velocity of the fixes at a moment: cubic between four of them.
inline std::optional<Vector3> velocity_at(const std::vector<Fix>& fixes, double time_s) {
  const auto after = std::find_if(fixes.begin(), fixes.end(), [&](const Fix& fix) { return fix.time_s >= time_s; });
  const auto i = after - fixes.begin();
  if (i < 2 || i + 1 >= static_cast<std::ptrdiff_t>(fixes.size())) {
    return std::nullopt;
  }
  Vector3 sum = Vector3::Zero();
  for (std::ptrdiff_t j = i - 2; j < i + 2; ++j) {
    const Fix& own = fixes[static_cast<std::size_t>(j)];
    if (!own.velocity_ned_m_s || std::abs(own.time_s - time_s) > 1.6) {
      return std::nullopt;
    }
    double weight = 1.0;
    for (std::ptrdiff_t k = i - 2; k < i + 2; ++k) {
      const double other = fixes[static_cast<std::size_t>(k)].time_s;
      weight *= k == j ? 1.0 : (time_s - other) / (own.time_s - other);
    }
    sum += weight * *own.velocity_ned_m_s;
  }
  return sum;
}

/// Where a vehicle is turned to while it is driven: by the poses that the filter finds at its fixes and by what the
/// unit reads between them.
class RecordedAttitude {
 public:
  RecordedAttitude(const Drive& drive, const FilterOptions& options) : run_(drive.runs.front()) {
    const auto prepared = drive::PreparedDrive::make(drive, options);
    EXPECT_TRUE(prepared);
    drive::FilterTask task;
    task.keep_poses = true;
    poses_ = prepared->run(0, task).poses;
  }
  /// Body to north, east, down, at the end of the reading nearest to a moment of the unit's clock.
  [[nodiscard]] Quaternion at(double time_s) const {
    const auto pose = std::min_element(poses_.begin(), poses_.end(), [&](const auto& a, const auto& b) {
      return std::abs(a.time_s - time_s) < std::abs(b.time_s - time_s);
    });
    Quaternion attitude = from_euler(pose->attitude);
    const auto at_pose = std::lround((pose->time_s - run_.start_s) / run_.dt_s);
    const auto here = std::clamp<std::ptrdiff_t>(std::lround((time_s - run_.start_s) / run_.dt_s), 0,
                                                 static_cast<std::ptrdiff_t>(run_.readings.size()));
    for (std::ptrdiff_t k = at_pose; k < here; ++k) {
      attitude = attitude * rotation(run_.dt_s * rate(k));
    }
    for (std::ptrdiff_t k = at_pose; k > here; --k) {
      attitude = attitude * rotation(-run_.dt_s * rate(k - 1));
    }
    return attitude;
  }

 private:
  [[nodiscard]] Vector3 rate(std::ptrdiff_t i) const {
    const ImuSample& sample = run_.readings[static_cast<std::size_t>(i)];
    return {sample[0], sample[1], sample[2]};
  }
  const drive::UniformRun& run_;
  std::vector<RecordedPose> poses_;
};

/// Velocities as they were `by_s` before: less what the unit reads to have been gained since. Between fixes of 4 Hz
/// they cannot be interpolated: a car pitches at 1 to 2 Hz, and velocities that are smoothed there look like those of
/// an antenna that is 0.1 m lower.
inline void delay_velocities(Drive& changed, const FilterOptions& options, double by_s) {
  const RecordedAttitude attitude(changed, options);
  const drive::UniformRun& run = changed.runs.front();
  for (Fix& fix : changed.fixes) {
    const double end = (fix.time_s - options.velocity_latency_s - options.imu_offset_s - run.start_s) / run.dt_s;
    const double begin = end - by_s / run.dt_s;
    if (!fix.velocity_ned_m_s || begin < 0.0 || end >= static_cast<double>(run.readings.size())) {
      continue;
    }
    const Vector3 gravity = ned_axes(fix.position_ecef_m).transpose() * normal_gravity(fix.position_ecef_m);
    for (auto i = static_cast<std::size_t>(begin); static_cast<double>(i) < end; ++i) {
      const double share = std::min(end, static_cast<double>(i + 1)) - std::max(begin, static_cast<double>(i));
      const ImuSample& sample = run.readings[i];
      const Vector3 force(sample[3], sample[4], sample[5]);
      *fix.velocity_ned_m_s -=
          share * run.dt_s * (attitude.at(run.start_s + (static_cast<double>(i) + 0.5) * run.dt_s) * force + gravity);
    }
  }
}

/// The antenna `arm` further from the unit, by the attitude that the filter finds and the rate that the unit reads.
inline void move_antenna(Drive& changed, const FilterOptions& options, const Vector3& arm) {
  const RecordedAttitude recorded(changed, options);
  const drive::UniformRun& run = changed.runs.front();
  for (Fix& fix : changed.fixes) {
    const Quaternion attitude = recorded.at(fix.time_s - options.imu_offset_s);
    const auto rate_at = [&](double time_s) {
      const auto middle = static_cast<std::ptrdiff_t>((time_s - options.imu_offset_s - run.start_s) / run.dt_s);
      Vector3 mean = Vector3::Zero();
      for (std::ptrdiff_t i = middle - 5; i < middle + 5; ++i) {
        const auto at = static_cast<std::size_t>(
            std::clamp<std::ptrdiff_t>(i, 0, static_cast<std::ptrdiff_t>(run.readings.size()) - 1));
        mean += 0.1 * Vector3(run.readings[at][0], run.readings[at][1], run.readings[at][2]);
      }
      return mean;
    };
    fix.position_ecef_m += ned_axes(fix.position_ecef_m) * (attitude * arm);
    if (fix.velocity_ned_m_s) {
      *fix.velocity_ned_m_s += attitude * rate_at(fix.time_s - options.velocity_latency_s).cross(arm);
    }
  }
}

inline void turn_unit(Drive& changed, const Matrix3& by, const Matrix3& gyroscope, const Matrix3& accelerometer) {
  for (drive::UniformRun& run : changed.runs) {
    for (ImuSample& sample : run.readings) {
      const Vector3 rate =
          by * (Vector3(sample[0], sample[1], sample[2]) + gyroscope * Vector3(sample[0], sample[1], sample[2]));
      const Vector3 force =
          by * (Vector3(sample[3], sample[4], sample[5]) + accelerometer * Vector3(sample[3], sample[4], sample[5]));
      sample = {rate.x(), rate.y(), rate.z(), force.x(), force.y(), force.z()};
    }
  }
}

inline Matrix3 single(int row, int column, double value) {
  Matrix3 matrix = Matrix3::Zero();
  matrix(row, column) = value;
  return matrix;
}

/// A unit that samples `by_hz` faster than the recorded one and is asked at 100 Hz: the host writes the newest reading
/// that is ready. Own readings are means of the recorded ones.
inline void sample_at_another_rate(Drive& changed, double by_hz) {
  const drive::UniformRun recorded = std::move(changed.runs.front());
  std::vector<ImuSample> integral(recorded.readings.size() + 1, ImuSample{});
  for (std::size_t i = 0; i < recorded.readings.size(); ++i) {
    for (std::size_t c = 0; c < kImuChannels; ++c) {
      integral[i + 1][c] = integral[i][c] + recorded.dt_s * recorded.readings[i][c];
    }
  }
  const auto integral_at = [&](double since_s, std::size_t c) {
    const double place = std::clamp(since_s / recorded.dt_s, 0.0, static_cast<double>(recorded.readings.size()));
    const auto i = std::min(static_cast<std::size_t>(place), recorded.readings.size() - 1);
    return integral[i][c] + (place - static_cast<double>(i)) * (integral[i + 1][c] - integral[i][c]);
  };
  const double own_s = 1.0 / (1.0 / recorded.dt_s + by_hz);
  const double length_s = recorded.end_s() - recorded.start_s;
  drive::SensorLog log;
  for (double asked_s = 0.05; asked_s < length_s; asked_s += 0.01) {
    const double end_s = std::floor(asked_s / own_s) * own_s;
    ImuSample sample{};
    for (std::size_t c = 0; c < kImuChannels; ++c) {
      sample[c] = (integral_at(end_s, c) - integral_at(end_s - own_s, c)) / own_s;
    }
    log.time_s.push_back(recorded.start_s + asked_s);
    log.readings.push_back(sample);
  }
  changed.facts.sampling = {};
  auto runs = drive::uniform_readings(std::move(log), {drive::SensorClock::Host, true}, changed.facts.sampling);
  ASSERT_TRUE(runs);
  changed.runs = std::move(*runs);
}

/// By how much the receiver's velocities are late, by the fixes alone.
inline double velocities_late_s(const Drive& recorded) {
  const auto delay = drive::delay_from_fixes(recorded.fixes);
  return delay ? delay->delay_s : 0.0;
}

/// An odometer at 10 Hz and 0.1 m/s of noise of its own, that reads the speed of the fixes.
inline void add_odometer(Drive& changed) {
  const double late_s = velocities_late_s(changed);
  changed.document.odometer.emplace();
  Random random(1, 9);
  for (double time_s = 1.0; time_s < changed.end_s(); time_s += 0.1) {
    if (const auto velocity = velocity_at(changed.fixes, time_s + late_s)) {
      changed.odometer.push_back({time_s, velocity->norm() + changed.document.odometer->sd_m_s * random.normal()});
    }
  }
}

/// The document states the heading of the first fix: the course by which a filter would begin, less what the gyroscope
/// has turned since.
inline void state_heading(Drive& changed) {
  const auto start = find_start(changed, 0);
  ASSERT_TRUE(start);
  const auto rests = rests_of(changed, 0);
  ASSERT_FALSE(rests.empty());
  const drive::UniformRun& run = changed.runs.front();
  double turned = 0.0;
  for (std::size_t i = 0; i < start->reading; ++i) {
    turned += (run.readings[i][2] - rests.front().rate.z()) * run.dt_s;
  }
  changed.document.start.heading_rad = start->attitude().heading_rad - turned;
}

/// Gauss-Markov errors of positions that last for 20 s, one and a half times as large down as north and east.
inline void add_lasting_errors(Drive& changed, double sigma_m) {
  constexpr double kLasting = 20.0;  // [s]
  Random random(1, 6);
  Vector3 error = Vector3::Zero();
  double before_s = -1e9;
  for (Fix& fix : changed.fixes) {
    const double phi = std::exp(-(fix.time_s - before_s) / kLasting);
    before_s = fix.time_s;
    for (Eigen::Index k = 0; k < 3; ++k) {
      error(k) = phi * error(k) + sigma_m * (k == 2 ? 1.5 : 1.0) * std::sqrt(1.0 - phi * phi) * random.normal();
    }
    fix.position_ecef_m += ned_axes(fix.position_ecef_m) * error;
  }
}

/// Power of a channel above about 5 Hz in blocks of half a second, over its mean.
inline std::vector<double> vibration_of(const drive::UniformRun& run, std::size_t channel, std::size_t block) {
  std::vector<double> power(run.readings.size() / block, 0.0);
  double mean = 0.0;
  for (std::size_t i = 0; i < power.size() * block; ++i) {
    const std::size_t first = i < 5 ? 0 : i - 5;
    const std::size_t last = std::min(i + 6, run.readings.size());
    double slow = 0.0;
    for (std::size_t k = first; k < last; ++k) {
      slow += run.readings[k][channel] / static_cast<double>(last - first);
    }
    const double fast = run.readings[i][channel] - slow;
    power[i / block] += fast * fast;
    mean += fast * fast / static_cast<double>(power.size());
  }
  for (double& each : power) {
    each /= mean;
  }
  return power;
}

/// Squared density of the noise that the drive's own search believes a channel to have, on average.
inline double noise_square(const Drive& recorded, const FilterOptions& options, std::size_t channel) {
  const double factor = channel < 3 ? options.gyro_noise : options.force_noise;
  return factor * factor * drive::white_square_of(recorded.document.model.axes[channel]);
}

/// A third of the time the unit is shaken at 20 Hz, by far more than the road shakes it, and the gyroscope's noise is
/// larger there, by `ratio` times all of its noise over the whole drive.
inline void shake(Drive& changed, const FilterOptions& options, double ratio) {
  drive::UniformRun& run = changed.runs.front();
  Random random(1, 5);
  for (std::size_t i = 0; i < run.readings.size(); ++i) {
    const double time_s = static_cast<double>(i) * run.dt_s;
    for (std::size_t c = 0; c < 3 && std::fmod(time_s, 60.0) > 40.0; ++c) {
      run.readings[i][c] += 40.0 * kDegree * std::sin(2.0 * std::numbers::pi * 20.0 * time_s) +
                            std::sqrt(3.0 * ratio * noise_square(changed, options, c) / run.dt_s) * random.normal();
    }
  }
}

/// Noise of the kind that a sensor has already, as much of it in proportion to the vibration, that makes all of it
/// `factor` times as large.
inline void add_noise(Drive& changed, const FilterOptions& options, std::size_t first_channel, double factor) {
  drive::UniformRun& run = changed.runs.front();
  const auto block = static_cast<std::size_t>(0.5 / run.dt_s);
  const double share = first_channel == 0 ? options.gyro_vibration : options.force_vibration;
  Random random(1, 4);
  for (std::size_t c = first_channel; c < first_channel + 3; ++c) {
    const std::vector<double> power = vibration_of(run, c, block);
    const double variance = (factor * factor - 1.0) * noise_square(changed, options, c) / run.dt_s;
    for (std::size_t i = 0; i < run.readings.size(); ++i) {
      const double relative = power[std::min(i / block, power.size() - 1)];
      run.readings[i][c] += std::sqrt(variance * (1.0 - share + share * relative)) * random.normal();
    }
  }
}

/// White noise that has nothing of the vibration, `ratio` times all of the gyroscope's.
inline void add_even_noise(Drive& changed, const FilterOptions& options, double ratio) {
  FilterOptions even = options;
  even.gyro_vibration = 0.0;
  add_noise(changed, even, 0, std::sqrt(1.0 + ratio));
}

/// What a drive is before a cause is put in.
enum class Ground { AsRecorded, Constrained, WithOdometer, HeadingStated };

struct Injected {
  const char* cause;
  const char* parameter;
  double size;  ///< SI
  Ground ground;
  std::function<void(Drive& changed, const FilterOptions& options, double size)> put;
  /// By how much the finding changes then, in its unit; null: by `size`.
  std::function<double(const FilterOptions& options, double size)> change = nullptr;
  double within = 0.0;  ///< beside a fifth of the change and three standard errors, in the finding's unit
};

inline std::vector<Injected> recorded_injections() {
  const Matrix3 one = Matrix3::Identity();
  const Matrix3 none = Matrix3::Zero();
  return {
      {"sample_clock", "rate_hz", -3.0, Ground::AsRecorded,
       [](Drive& d, const FilterOptions&, double by) { sample_at_another_rate(d, by); }},
      {"imu_time_offset", "delta_s", 0.030, Ground::AsRecorded,
       [](Drive& d, const FilterOptions&, double by) { d.runs.front().start_s -= by; }},
      {"gnss_velocity_latency", "delay_s", 0.060, Ground::AsRecorded, delay_velocities},
      {"gnss_lever_arm", "x", 0.4, Ground::AsRecorded,
       [](Drive& d, const FilterOptions& o, double by) { move_antenna(d, o, {by, 0.0, 0.0}); }},
      {"gnss_lever_arm", "y", 0.4, Ground::AsRecorded,
       [](Drive& d, const FilterOptions& o, double by) { move_antenna(d, o, {0.0, by, 0.0}); }},
      {"gyro_scale_factor_error", "z", 0.02, Ground::AsRecorded,
       [=](Drive& d, const FilterOptions&, double by) { turn_unit(d, one, single(2, 2, by), none); }},
      {"gyro_axis_misalignment", "xz", 0.02, Ground::AsRecorded,
       [=](Drive& d, const FilterOptions&, double by) { turn_unit(d, one, single(0, 2, by), none); }},
      {"accelerometer_scale_factor_error", "x", 0.04, Ground::AsRecorded,
       [=](Drive& d, const FilterOptions&, double by) { turn_unit(d, one, none, single(0, 0, by)); }},
      // Lasting errors show by sigma^2/tau from fix to fix; along that ridge the likelihood is flat.
      {"gnss_coloured_noise", "sigma", 0.3, Ground::AsRecorded,
       [](Drive& d, const FilterOptions&, double sigma) { add_lasting_errors(d, sigma); }, nullptr, 0.15},
      {"vibration_noise", "gyroscope", 5.0, Ground::AsRecorded, shake,
       [](const FilterOptions& o, double ratio) { return 100.0 * (ratio / (1.0 + ratio) - o.gyro_vibration); }},
      {"vibration_noise", "gyroscope", 3.0, Ground::AsRecorded, add_even_noise,
       [](const FilterOptions& o, double ratio) { return -100.0 * o.gyro_vibration * ratio / (1.0 + ratio); }},
      {"noise_level", "gyroscope", 2.0, Ground::AsRecorded,
       [](Drive& d, const FilterOptions& o, double factor) { add_noise(d, o, 0, factor); }},
      {"noise_level", "accelerometer", 2.0, Ground::AsRecorded,
       [](Drive& d, const FilterOptions& o, double factor) { add_noise(d, o, 3, factor); }},
      {"mounting_angles", "yaw", 2.0 * kDegree, Ground::Constrained,
       [=](Drive& d, const FilterOptions&, double by) {
         turn_unit(d, Eigen::AngleAxisd(by, Vector3::UnitZ()).toRotationMatrix(), none, none);
       }},
      {"mounting_angles", "pitch", 2.0 * kDegree, Ground::Constrained,
       [=](Drive& d, const FilterOptions&, double by) {
         turn_unit(d, Eigen::AngleAxisd(by, Vector3::UnitY()).toRotationMatrix(), none, none);
       }},
      {"odometer_scale", "S", 0.03, Ground::WithOdometer,
       [](Drive& d, const FilterOptions&, double by) {
         for (drive::OdometerReading& reading : d.odometer) {
           reading.speed_m_s *= 1.0 + by;
         }
       }},
      {"wheel_slip", "seconds", 2.0, Ground::WithOdometer,
       [](Drive& d, const FilterOptions&, double by) {
         for (drive::OdometerReading& reading : d.odometer) {
           reading.speed_m_s += reading.time_s > 250.0 && reading.time_s < 253.0 ? by : 0.0;
         }
       },
       [](const FilterOptions&, double) { return 3.0 + 2.0 * 0.3; }},  // said to begin and to end between two readings
      {"initial_heading", "heading", 40.0 * kDegree, Ground::HeadingStated,
       [](Drive& d, const FilterOptions&, double by) { *d.document.start.heading_rad -= by; }},
  };
}

}  // namespace driftlab::accuracy
