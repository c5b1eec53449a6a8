#pragma once
/// The assumptions of a filter over a recorded drive beside the error model: clocks, lever arms, constraints and
/// estimated constants; and the effect of these assumptions on the readings and their noise.
#include "core/navigate/drive/drive.hpp"
#include "core/navigate/drive/vibration.hpp"
#include "core/process/random.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

namespace driftlab::drive {

/// A vehicle on its axle moves along its nose: with mounting errors yaw and pitch and the axle x ahead of the unit,
///   v_y = yaw v_x - x w_z,   v_z = -pitch v_x + x w_y      (spec/drives.md, section 6)
/// in body axes at the unit, up to a white side slip.
struct Constraint {
  double rate_hz = 10.0;
  double sd_m_s = 0.3;
  double yaw_rad = 0.0;
  double pitch_rad = 0.0;
  double axle_m = 0.0;  ///< forward of the unit; of a rear axle mostly negative
  bool operator==(const Constraint&) const = default;
};

/// Errors of the readings that are taken off before the filter: reading = (I + M) truth, in body axes.
struct ReadingErrors {
  Matrix3 gyroscope = Matrix3::Zero();
  Matrix3 accelerometer = Matrix3::Zero();
  [[nodiscard]] bool none() const { return gyroscope.isZero(0.0) && accelerometer.isZero(0.0); }
  bool operator==(const ReadingErrors&) const = default;
};

struct FilterOptions;

/// A number of the options that a filter estimates beside everything else: an unknown constant around the value that
/// the options have. Whatever measurement depends on it shows it; the filter knows no more of it than how to turn it.
struct EstimatedConstant {
  void (*turn)(FilterOptions& options, double by) = nullptr;  ///< SI
  double sd = 0.0;                                            ///< SI
  bool operator==(const EstimatedConstant&) const = default;
};

/// Errors of a receiver's positions that last: a Gauss-Markov process in north, east and, one and a half times as
/// large, down. The filter estimates them beside everything else.
struct ColouredFixes {
  double sigma_m = 0.0;  ///< 0: there are none; the sign does not count
  double tau_s = 10.0;
  [[nodiscard]] bool none() const { return std::abs(sigma_m) < 1e-4; }
  [[nodiscard]] Vector3 sd_m() const { return std::abs(sigma_m) * Vector3(1.0, 1.0, 1.5); }
  bool operator==(const ColouredFixes&) const = default;
};

struct FilterOptions {
  double imu_offset_s = 0.0;        ///< added to the unit's stamps
  double position_latency_s = 0.0;  ///< stamp minus the moment that a position describes
  double velocity_latency_s = 0.0;
  /// How far the velocities of fixes are means over the time before them rather than velocities of one moment: 1 if
  /// they are means over twice the delay d by which they are older than the positions, which end at the positions'
  /// moment.
  double velocity_averaging = 0.0;
  Vector3 lever_arm_m = Vector3::Zero();
  ReadingErrors errors;
  double gyro_noise = 1.0;  ///< factor of the model's white noise
  double force_noise = 1.0;
  double gyro_vibration = 0.0;  ///< share of the white noise's mean power that follows the vibration (vibration.hpp)
  double force_vibration = 0.0;
  ColouredFixes coloured;
  double initial_heading_rad = 0.0;  ///< added to the heading of the start
  std::optional<Constraint> constraint;
  bool zero_velocity = false;
  bool odometer = false;
  double odometer_scale = 0.0;                    ///< odometer = (1 + scale) speed
  std::vector<std::array<double, 2>> slips = {};  ///< from, to [s]: the wheel slips, and its readings are not used
  std::vector<EstimatedConstant> constants = {};
  double gate = 0.0;     ///< a fix whose normalised squared innovation is above is rejected; 0: none
  int gate_memory = 60;  ///< disagreeing fixes that are remembered once the receiver is believed again (fix_gate.hpp)
  bool date_to_sample =
      false;  ///< fixes count as of the end of their sample: what a filter does that ignores their dates
  bool operator==(const FilterOptions&) const = default;
};

/// The time over which velocities of fixes are means, T [s], around the moment that they describe. A mean over T
/// differs from the velocity in the middle by T^2/24 of the rate of change of the acceleration: T = 2 d
/// sqrt(averaging).
[[nodiscard]] double velocity_mean_s(const FilterOptions& options);

/// The options that the document states: lever arm and latencies.
[[nodiscard]] FilterOptions options_of(const Document& document);

/// What follows the vibration at most: without any other noise a filter would believe readings in calm to be exact.
inline constexpr double kMostShaken = 0.999;

/// Share of the mean power of a channel's white noise that follows the vibration, from 0 to kMostShaken.
[[nodiscard]] double shaken_share(const FilterOptions& options, std::size_t channel);

/// That share over the rest of the power.
[[nodiscard]] double shaken_over_even(const FilterOptions& options, std::size_t channel);

/// Multiplies the white noise of an axis, at every rate.
void scale_white_noise(AxisModel& axis, double factor);

/// Adds the noise that follows the vibration, by the options' shares, to readings simulated from `model`, the design's
/// model of the noise that does not follow it.
void add_vibration_noise(const Vibration& vibration, const FilterOptions& options, const ImuModel& model, double dt_s,
                         Random& random, std::vector<ImuSample>& readings);

/// The factor by which correcting the readings for M changes the white noise density of a channel: the length of the
/// channel's row of (I + M)^-1, for axes with the same noise. A filter without this factor would prefer corrections
/// that merely make the readings quieter, and find a scale factor on every axis that hardly turns.
[[nodiscard]] double noise_after_correction(const ReadingErrors& errors, std::size_t channel);

/// Factors of the white noise of an axis that do not follow the vibration.
[[nodiscard]] double even_noise_factor(const FilterOptions& options, std::size_t channel);

[[nodiscard]] std::vector<ImuSample> corrected_readings(const UniformRun& run, const ReadingErrors& errors);

}  // namespace driftlab::drive
