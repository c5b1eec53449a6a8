#pragma once
/// A recorded drive, loaded: even readings in body axes, dated fixes, a reference, on one clock that starts at the
/// first reading.
#include "core/navigate/drive/document.hpp"
#include "core/navigate/drive/sampling.hpp"
#include "core/navigate/drive/table.hpp"
#include "core/navigate/navigation_filter.hpp"

#include <optional>
#include <string>
#include <vector>

namespace driftlab::drive {

/// One fix as the receiver stamped it. Position and velocity may describe different moments; the filter's options say
/// which.
struct Fix {
  double time_s = 0.0;
  Vector3 position_ecef_m = Vector3::Zero();
  Vector3 position_sd_m = Vector3::Ones();  ///< north, east, down
  std::optional<Vector3> velocity_ned_m_s;
  Vector3 velocity_sd_m_s = Vector3::Ones();
  bool has_course = false;  ///< the velocity says where the vehicle goes
};

struct OdometerReading {
  double time_s = 0.0;
  double speed_m_s = 0.0;
};

/// Facts of the drive's files, and the repairs that were made.
struct FileFacts {
  SamplingFacts sampling;
  StampFacts imu_stamps, gnss_stamps;
  std::size_t fixes = 0;                    ///< used
  std::size_t held = 0;                     ///< rows that repeat a fix
  std::size_t other_types = 0;              ///< rows of a fix type that is not to be used
  std::size_t incomplete = 0;               ///< rows without a position
  std::size_t far_away = 0;                 ///< placeholders before the first fix, and the like
  std::size_t outside_readings = 0;         ///< a second and more before the first reading or after the last
  bool accuracy_constant = false;           ///< the position's; not used
  bool speed_accuracy_constant = false;     ///< not used
  bool vertical_accuracy_constant = false;  ///< not used
  bool height_zero = false;                 ///< every height is 0: not measured
  bool course_constant = false;             ///< the same number throughout; no velocity comes of it
  std::size_t without_accuracy = 0;         ///< accuracies of used fixes that are no number above 0
  std::size_t without_type = 0;             ///< of `other_types`, rows without a fix type
  std::size_t reference_gaps = 0;           ///< of a reference of its own, too long to compare within
  double reference_gaps_s = 0.0;
  double fix_rate_hz = 0.0;
  double highest_speed_m_s = 0.0;  ///< by the velocities of the fixes; where there are none, over 5 s of positions
  double length_m = 0.0;           ///< likewise
  std::vector<std::string> notes;  ///< sentences: facts of the drive that were not repaired
};

struct ReferencePoint {
  double time_s = 0.0;
  Vector3 position_ecef_m = Vector3::Zero();
};

struct Drive {
  Document document;
  double epoch_s = 0.0;          ///< the clock's zero on the sources' scale: the first reading
  std::vector<UniformRun> runs;  ///< body axes
  std::vector<Fix> fixes;
  std::vector<ReferencePoint> reference;  ///< by time
  bool withheld_fixes = false;            ///< the reference is the fixes themselves
  std::vector<OdometerReading> odometer;
  FileFacts facts;

  [[nodiscard]] double end_s() const { return runs.back().end_s(); }
  /// Whether any fix has a velocity.
  [[nodiscard]] bool has_velocities() const;
  /// A place on the map of the drive: north, east and down of where its reference begins [m].
  [[nodiscard]] Vector3 on_map(const Vector3& position_ecef_m) const;
};

/// A reference says where the vehicle is between two points that lie no farther from the moment than this [s].
inline constexpr double kNearestReference = 1.6;

/// The decoded files of a document.
struct Tables {
  Table imu;
  std::optional<Table> force;
  Table gnss;
  std::optional<Table> reference;
  std::optional<Table> odometer;
};

struct LoadOptions {
  bool repair = true;  ///< false: repeats stay and stamps are believed
};

/// Errors: those of check, stamp_rows and uniform_readings, UnknownColumn; InconsistentSampling (sources that share no
/// clock or do not overlap); InvalidArgument, where the numbers cannot be what the document calls them: latitudes
/// beyond 90 deg, radians for degrees, g for m/s^2, up for down, left-handed axes.
[[nodiscard]] Result<Drive> load_drive(const Document& document, const Tables& tables, const LoadOptions& options = {});

/// Fixes of a table, on its own clock, without those that repeat, lack a position or are of another type. Errors:
/// UnknownColumn, InvalidArgument, TooFewSamples.
[[nodiscard]] Result<std::vector<Fix>> fixes_of(const GnssSource& source, const Table& table,
                                                const StampedRows& stamped, FileFacts& facts);

/// Checks that the sources agree on the motion. Error: InvalidArgument, whose sentence states the repair.
[[nodiscard]] Status check_plausible(const Drive& drive);

/// C that turns sensor axes into body axes for the mounting angles roll, pitch, yaw.
[[nodiscard]] Matrix3 mounting_matrix(const EulerAngles& mounting);

/// The mounting of a unit of a vehicle that moves along its nose: roll and pitch from the mean force of even motion,
/// yaw from force across the vertical against change of speed and speed times turning rate. `readings` are in sensor
/// axes, turned by nothing. Error: InvalidArgument where the drive never changes its speed enough.
[[nodiscard]] Result<Matrix3> found_mounting(const std::vector<UniformRun>& runs, const std::vector<Fix>& fixes);

}  // namespace driftlab::drive
