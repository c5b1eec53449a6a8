#pragma once
/// What a column measures, guessed from its name alone.
#include "core/signal/recording.hpp"

#include <string_view>

namespace driftlab {

/// The role a column called `name` most likely has; Unspecified without unit where the name says nothing.
///
/// A unit in brackets at the end (`gyro_x [deg/s]`, `time (ms)`, `Gyroscope x (rad/s)`) is taken if it is known. What
/// is left is compared without case, blanks and punctuation:
///   time             t, ts, time, timestamp, seconds_elapsed, millis, and with a unit behind `_` (time_ms, t_us)
///   temperature      temp, temperature
///   angular rate     g gyr gyro gyroscope w omega rate angular_rate angular_velocity, with x, y or z behind or before
///   it specific force   a acc accel accelerometer acceleration f specific_force, likewise magnetic field   m mag
///   magnetometer magnetic_field, likewise
/// Words in front that change nothing are skipped: raw_acceleration_x_gs, imu_gyr_x, imu.wb_z, GyroscopeUncalibrated
/// stays unknown. A bare axis letter takes its quantity from the unit: `X (rad/s)` is an angular rate.
[[nodiscard]] ColumnRole infer_role(std::string_view name);

/// Refuses a name that says what the column measures, but in brackets a unit that is not known: to analyse
/// `gz [furlong]` in unit 1 would be a wrong answer. Words that state raw numbers are no units (`gz (LSB)`,
/// `acc_x [counts]`, `time (UTC)`), and a name that tells no role may say anything in brackets. Error: UnknownUnit with
/// fields `column` and `unit`.
[[nodiscard]] Status check_bracketed_unit(std::string_view name);

}  // namespace driftlab
