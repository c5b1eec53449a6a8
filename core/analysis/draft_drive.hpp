#pragma once
/// The use case "draft a drive": the drive document of a log, as far as the names of its columns say what they hold.
///
/// A flight log or a bag holds the readings of the inertial unit and the receiver's fixes side by side; elsewhere each
/// has a file of its own. Writing down which column is which is most of a drive document (spec/drives.md, section 1),
/// and the readers of driftlab name columns so that this can be read off: `gyro_x (rad/s)`, `gnss_latitude (deg)`. What
/// no name can say is taken as it is most often and told in a note: the vehicle, where the unit and the antenna sit,
/// and what the filter believes of the unit.
#include "core/navigate/drive/document.hpp"
#include "core/signal/recording.hpp"

#include <optional>
#include <string>
#include <vector>

namespace driftlab {

/// A decoded file.
struct DraftFile {
  std::string file;    ///< its name, as the document will have it
  std::string format;  ///< name of its reader (core/read/format.hpp)
  ColumnNames names;
  RecordingSpec spec;  ///< what is stated of its columns and of its rate; empty: the names speak
};

struct DraftRequest {
  DraftFile unit;
  std::optional<DraftFile> receiver;  ///< nothing: the fixes are in the unit's file
  drive::Vehicle vehicle = drive::Vehicle::Road;
};

struct DraftColumn {
  std::string name;
  drive::Quantity quantity = drive::Quantity::Ignored;
  std::string axis;
  std::string unit;  ///< empty: it has none
};

struct DraftSource {
  std::string file;
  std::vector<DraftColumn> columns;
  std::string time_column;  ///< empty where the scale is Row
  std::string time_unit;
  drive::TimeScale scale = drive::TimeScale::Boot;
  std::optional<double> rate_hz;  ///< where the scale is Row
};

/// What the filter is told of a unit that nobody has characterised: an ordinary one of a phone or a car, as data sheets
/// and the shared drives have them.
struct OrdinaryUnit {
  double gyro_white_deg_sqrt_h = 0.6;  ///< N
  double gyro_walk_deg_h_sqrt_h = 43;  ///< K
  double gyro_bias_deg_s = 0.5;
  double force_white_m_s_sqrt_h = 0.12;
  double force_walk_mg_sqrt_h = 1.2;
  double force_bias_mg = 20;
};

struct DriveDraft {
  std::string id;
  drive::Vehicle vehicle = drive::Vehicle::Road;
  DraftSource unit;
  DraftSource receiver;
  bool geoid = false;  ///< heights are above the geoid
  OrdinaryUnit model;
  bool mounting_unknown = false;  ///< to be found from the drive; else the axes are taken for the vehicle's
  std::vector<std::string> notes;
};

/// Errors: UnknownColumn, where an axis of the gyroscope or accelerometer, latitude, longitude or the time of the fixes
/// has no column by its name; InvalidArgument (neither times nor a rate of the unit); those of assign_roles.
[[nodiscard]] Result<DriveDraft> draft_drive(const DraftRequest& request);

}  // namespace driftlab
