#pragma once
/// One run of the navigation filter over a recorded drive, with outages.
///
/// Every fix is dated to its own moment: position and velocity of a fix are two measurements, each applied at the first
/// sample that ends after the moment it describes and carried back by the time between. (Applied at the end of the
/// sample as if they were of then, fixes are up to a sample late: 15 cm at 15 m/s and 100 Hz, a sawtooth that doubles
/// the uncertainty of everything that is found from the innovations.)
///
/// A fix is withheld from an outage if its stamp or a moment that it describes lies in [start, end). What is withheld
/// leaves no trace: without it in the file the result is the same to the bit.
///
/// At the end of an outage, before the first returning fix, the antenna's estimate is compared with the reference.
#include "core/navigate/drive/start.hpp"
#include "core/navigate/recorded_motion.hpp"

#include <array>
#include <functional>

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
};

/// Errors of the readings that are taken off before the filter: reading = (I + M) truth, in body axes.
struct ReadingErrors {
  Matrix3 gyroscope = Matrix3::Zero();
  Matrix3 accelerometer = Matrix3::Zero();
  [[nodiscard]] bool none() const { return gyroscope.isZero(0.0) && accelerometer.isZero(0.0); }
};

/// Constants that a filter estimates beside everything else: their standard deviations; nothing: they are known.
struct EstimatedConstants {
  std::optional<double> lever_arm_sd_m;
  std::optional<double> mounting_sd_rad;  ///< yaw and pitch of the constraint
  std::optional<double> axle_sd_m;
  std::optional<double> odometer_scale_sd;
};

struct FilterOptions {
  double imu_offset_s = 0.0;        ///< added to the unit's stamps
  double position_latency_s = 0.0;  ///< stamp minus the moment that a position describes
  double velocity_latency_s = 0.0;
  Vector3 lever_arm_m = Vector3::Zero();
  ReadingErrors errors;
  double gyro_noise = 1.0;  ///< factor of the model's white noise
  double force_noise = 1.0;
  std::optional<Constraint> constraint;
  bool zero_velocity = false;
  bool odometer = false;
  double odometer_scale = 0.0;  ///< odometer = (1 + scale) speed
  EstimatedConstants constants;
  double gate = 0.0;  ///< a fix whose normalised squared innovation is above is rejected; 0: none
  bool date_to_sample =
      false;  ///< fixes count as of the end of their sample: what a filter does that ignores their dates
};

/// What the document says: arm, latencies and their uncertainty.
[[nodiscard]] FilterOptions options_of(const Document& document);

enum class MeasurementKind { Position, Velocity, Constraint, ZeroVelocity, Odometer };

/// The innovations of one measurement: scalars, each given those before it.
struct Innovation {
  double time_s = 0.0;  ///< of the moment described, on the drive's clock
  MeasurementKind kind = MeasurementKind::Position;
  int count = 0;
  std::array<ScalarInnovation, 3> scalar{};  ///< north, east, down; right, down
  bool accepted = true;
};

enum class OutageClass { Rest, Straight, Turning };
[[nodiscard]] std::string_view name_of(OutageClass outage_class);

struct DriveOutage {
  Outage outage;
  std::size_t phase = 0;
  Vector3 error_ned_m = Vector3::Zero();     ///< antenna minus reference
  Matrix3 covariance_ned = Matrix3::Zero();  ///< of the antenna's estimate and the reference [m^2]
  double along_m = 0.0, across_m = 0.0;
  double start_error_m = 0.0;
  double straight_line_error_m = 0.0;
  double heading_sd_rad = 0.0;  ///< at the end
  OutageClass outage_class = OutageClass::Straight;
  Vector3 reference_ecef_m = Vector3::Zero();

  [[nodiscard]] double error_m() const { return error_ned_m.head<2>().norm(); }
  [[nodiscard]] double nees() const;  ///< two dimensions
};

struct FilterRun {
  std::vector<DriveOutage> outages;
  std::vector<Innovation> innovations;
  std::vector<RecordedPose> poses;        ///< after every fix; empty unless asked for
  std::optional<double> heading_known_s;  ///< when the heading's standard deviation fell below 1 deg
  std::size_t rejected = 0;
};

/// Values that a constraint measures in place of zero, for simulated drives: (right, down) by reading.
using SideSlip = std::function<std::array<double, 2>(std::size_t reading)>;

struct FilterTask {
  std::vector<Outage> outages;  ///< by time, apart
  std::size_t phase = 0;
  bool keep_innovations = false;
  bool keep_poses = false;
  const SideSlip* slip = nullptr;
};

/// Multiplies the white noise of an axis whose model does not depend on the rate.
void scale_white_noise(AxisModel& axis, double factor);

/// A filter design for a drive's model under the options. Errors: those of FilterDesign::make.
[[nodiscard]] Result<FilterDesign> make_design(const Document& document, double dt_s, const Start& start,
                                               const FilterOptions& options);

/// Runs the filter from `start` to the end of its run. `readings` are those of the run with the options' errors taken
/// off (corrected_readings). Deterministic. About a microsecond a reading.
[[nodiscard]] FilterRun run_filter(const Drive& drive, const Start& start, std::span<const ImuSample> readings,
                                   const FilterDesign& design, const FilterOptions& options, const FilterTask& task);

[[nodiscard]] std::vector<ImuSample> corrected_readings(const UniformRun& run, const ReadingErrors& errors);

/// The reference at a moment, linear between its points; nothing where no points lie within 1.6 s on both sides.
[[nodiscard]] std::optional<Vector3> reference_at(const std::vector<ReferencePoint>& reference, double time_s);

}  // namespace driftlab::drive
