#pragma once
/// The drive document as values: the files of a recorded drive, the meaning of their columns, the mounting of the unit
/// in the vehicle, the error model of the filter, and the outages to simulate (spec/drives.md, section 1).
///
/// Lengths are metres, body axes forward, right, down. Times of the sources may be on different scales; those of one
/// drive must be convertible into each other (time_scale.hpp).
#include "core/navigate/drive/quantity.hpp"
#include "core/navigate/navigation_filter.hpp"

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace driftlab::drive {

/// Decides which constraints may be used.
enum class Vehicle { Road, Rail, Rover, Air, Foot, Boat };

[[nodiscard]] std::string_view name_of(Vehicle vehicle);
[[nodiscard]] std::optional<Vehicle> parse_vehicle(std::string_view name);

/// True for vehicles that move along their nose: non-holonomic constraints hold, and course is heading.
[[nodiscard]] bool moves_along_its_nose(Vehicle vehicle);

enum class TimeScale {
  Gps,   ///< seconds of GPS time; with or without whole weeks
  Utc,   ///< UTC: leap seconds are added once
  Unix,  ///< seconds since 1970 on a computer's clock, which follows UTC
  Boot,  ///< seconds since power-up of one computer
  Row,   ///< no clock: the number of the row at a stated rate
};

[[nodiscard]] std::string_view name_of(TimeScale scale);
[[nodiscard]] std::optional<TimeScale> parse_time_scale(std::string_view name);

/// The dates that an RTKLIB time tag gives to a file: GPS time of its first and of its last row, seconds since 1970.
struct TimeTag {
  double first_s = 0.0;
  double last_s = 0.0;
};

/// How the rows of one source lie in time.
struct TimeMeaning {
  std::string column;    ///< empty only where `scale` is Row
  double unit_s = 1.0;   ///< seconds in one of the column's unit
  bool arrival = false;  ///< the stamp is when the reading arrived, not what moment it describes
  TimeScale scale = TimeScale::Boot;
  double offset_s = 0.0;                        ///< added to the stamps
  std::optional<double> rate_hz;                ///< of the rows, where `scale` is Row
  std::string tag;                              ///< an RTKLIB time tag that dates the file; empty: none
  std::optional<TimeTag> dates = std::nullopt;  ///< what such a tag says, where the document says it itself
};

struct ColumnMeaning {
  Quantity quantity = Quantity::Ignored;
  std::string axis;
  double factor = 1.0;  ///< SI units in one of the column's unit
};

/// A file (or a stored recording), its columns by name or number, and its time.
struct Source {
  std::string file;
  std::map<std::string, ColumnMeaning> columns;
  TimeMeaning time;
};

/// How the inertial unit's stamps came to be.
enum class SensorClock {
  Sensor,   ///< by the sensor itself: they are true
  Host,     ///< by a computer that asked for a reading
  Arrival,  ///< by a computer that received it
};

struct ImuSource {
  Source source;
  /// Specific force in a file of its own; else in `source`.
  std::optional<Source> force;
  SensorClock clock = SensorClock::Sensor;
  /// Body = C sensor, C = R_x(roll) R_y(pitch) R_z(yaw) as rotations of axes (Groves 2013, eq. 2.22).
  EulerAngles mounting;
  /// Estimate roll and pitch from gravity and yaw from force against change of speed; `mounting` is then a first turn.
  bool mounting_unknown = false;
  double mounting_sd_rad = 0.0;
};

struct GnssSource {
  Source source;
  std::vector<int> fix_types;             ///< to be used; empty: all
  Vector3 lever_arm_m = Vector3::Zero();  ///< from the unit to the antenna
  double lever_arm_sd_m = 0.0;
  double position_latency_s = 0.0;  ///< by how much a stamp is later than the moment that its position describes
  double velocity_latency_s = 0.0;
  bool hold = false;   ///< the file repeats a fix until the next one
  bool geoid = false;  ///< heights are above the geoid: only horizontal results
  /// Standard deviations, north, east, down, for fixes that state none worth believing.
  Vector3 position_sd_m{3.0, 3.0, 6.0};
  Vector3 velocity_sd_m_s{0.3, 0.3, 0.6};
};

struct ReferenceSource {
  std::optional<Source> source;  ///< nothing: the withheld fixes
  bool smoothed = false;         ///< the filter's path smoothed over all fixes, in place of the withheld ones
  Vector3 lever_arm_m = Vector3::Zero();
  double sd_m = 0.0;  ///< of a reference that states none
};

struct OdometerSource {
  Source source;
  double metres_per_tick = 0.0;
  Vector3 lever_arm_m = Vector3::Zero();  ///< from the unit to the wheel
  double sd_m_s = 0.1;
};

/// Where the filter begins, where the document says so.
struct StartState {
  std::optional<Geodetic> position;
  std::optional<Vector3> velocity_ned_m_s;
  std::optional<double> heading_rad;
  std::optional<double> roll_rad, pitch_rad;
};

struct OutagePlan {
  std::vector<double> duration_s{10.0, 30.0, 60.0};
  std::vector<double> every_s{40.0, 60.0, 100.0};  ///< period of the outages of each duration
  int phases = 8;
  double settle_s = 60.0;    ///< from the moment at which the heading is known
  std::vector<double> at_s;  ///< starts instead of phases, seconds after the first reading
};

struct Document {
  std::string id;
  Vehicle vehicle = Vehicle::Road;
  ImuSource imu;
  GnssSource gnss;
  ReferenceSource reference;
  std::optional<OdometerSource> odometer;
  ImuModel model;
  StartState start;
  OutagePlan outages;
};

/// Errors: InvalidArgument naming the member: an arm of more than 30 m for a road vehicle, durations and periods that
/// do not pair, a period that leaves less than 20 s of fixes, no phases.
[[nodiscard]] Status check(const Document& document);

}  // namespace driftlab::drive
