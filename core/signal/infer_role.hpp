#pragma once
/// What a column measures, guessed from its name alone.
#include "core/signal/recording.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace driftlab {

/// The role that a column called `name` most likely has; Unspecified and without a unit if the name does not tell.
///
/// A unit in brackets at the end (`gyro_x [deg/s]`, `time (ms)`, `Gyroscope x (rad/s)`) is used if it is known. The
/// rest of the name is compared without regard to case, blanks and punctuation:
///
///   time             t, ts, time, timestamp, seconds_elapsed, millis; also with a unit behind `_` (time_ms, t_us);
///                    with a unit of time alone epoch, epoc, elapsed
///   temperature      temp, temperature, also of a sensor (gyro_temp); t with a unit of temperature or ° in brackets
///   angular rate     g gyr gyro gyroscope w omega rate angular_rate angular_velocity ang_rate gyro_rotation Drehrate
///                    Winkelgeschwindigkeit, with x, y or z before or behind
///   specific force   a acc accel accelerometer acceleration f specific_force accelerometer_acceleration
///                    Beschleunigung, likewise
///   magnetic field   m mag magnetometer magnetic_field, likewise
///
/// and also in the names that tools give: a unit behind `_` in one word or several (gyro_x_dps, gyro_x_rad_s,
/// acc_x_m_s2), an index for the axis (gyro_rad[0], accelerometer_m_s2[2], as PX4's ulog2csv), linear_acceleration_x as
/// in ROS. Leading words that change nothing are skipped: raw_acceleration_x_gs, imu_gyr_x and imu.wb_z are understood;
/// GyroscopeUncalibrated is not. A bare axis letter takes its quantity from the unit: `X (rad/s)` is an angular rate,
/// as is `x-axis (deg/s)` or `Rotation X (rad/s)`. A quantity by its unit, `acc_x/mg`, is read as well.
[[nodiscard]] ColumnRole infer_role(std::string_view name);

/// The structs of NaveGo among the columns of a file, by their names: those with the members `t`, `wb_x`, `wb_y`,
/// `wb_z`, `fb_x`, `fb_y` and `fb_z` (`imu_planetary.t`, ...), in the order of their times. Source: R. Gonzalez,
/// NaveGo, `imu_structure`: times in s, angular rates in rad/s, specific forces in m/s^2.
[[nodiscard]] std::vector<std::string> inertial_structs(const ColumnNames& names);

/// True where the columns of a recording mean what their names say: none is stated, or the time alone, which says
/// nothing of the others.
[[nodiscard]] bool reads_names(const RecordingSpec& spec);

/// The role of each column of a file: that of its struct, else that of its own name. Of two for one quantity and axis
/// an index, a linear_acceleration, a T (°C) or a gyro_temp yields to the plainer name; of several temperatures of
/// sensors the first is taken.
[[nodiscard]] std::vector<ColumnRole> infer_roles(const ColumnNames& names);

/// Refuses a name that states a quantity, but with a unit in brackets that is not known: to analyse `gz [furlong]` in
/// unit 1 would give a wrong answer. A temperature is not analysed: unknown_unit_of_temperature() says so instead.
/// Words for raw numbers and time zones are not taken as units (`gz (LSB)`, `acc_x [counts]`, `time (+0100)`), and a
/// name that implies no role may have anything in brackets. Error: UnknownUnit with fields `column` and `unit`.
[[nodiscard]] Status check_bracketed_unit(std::string_view name);

/// True where a known unit stands in brackets behind the name, whatever the name is.
[[nodiscard]] bool states_unit(std::string_view name);

/// What stands in brackets behind a name, whatever it is, and is no known unit, no word for raw numbers, no zone and no
/// index; empty where nothing does.
[[nodiscard]] std::string unread_unit(std::string_view name);

/// What stands in brackets behind the name of a temperature and is no known unit of one, `F` of `temp (F)`, `°` of
/// `T(°)`; empty for any other name.
[[nodiscard]] std::string unknown_unit_of_temperature(std::string_view name);

}  // namespace driftlab
