#pragma once
/// An outage of a recorded drive and a filter's error in it: the error of the antenna's estimate at its end, along and
/// across the way, its covariance, the growth of the error, and the motion of the vehicle meanwhile.
#include "core/navigate/drive/drive.hpp"
#include "core/navigate/drive/filter_options.hpp"
#include "core/navigate/error_covariance.hpp"
#include "core/navigate/trajectory.hpp"

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

namespace driftlab::drive {

/// Below this speed a vehicle rests [m/s].
inline constexpr double kRestSpeed = 0.5;

/// The error is noted this many times in an outage, evenly, the last time at its end.
inline constexpr std::size_t kGrowthPoints = 20;

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
  /// The horizontal error after each kGrowthPoints-th of the outage [m]; NaN where the reference says nothing.
  std::vector<double> growth_m;

  [[nodiscard]] double error_m() const { return error_ned_m.head<2>().norm(); }
  [[nodiscard]] double nees() const;  ///< two dimensions
};

/// The state of a filter at the start of an outage, and the growth of its error since.
struct OutageStart {
  double time_s = 0.0;  ///< on the drive's clock
  NavigationState state;
  std::vector<double> growth_m = {};  ///< as of DriveOutage, without the end
};

/// A filter's estimate of the pose at a moment of an outage.
struct OutageMoment {
  double time_s = 0.0;  ///< on the drive's clock
  NavigationState state;
  Matrix3 attitude = Matrix3::Identity();  ///< body to ECEF
  Vector3 lever_arm_m = Vector3::Zero();   ///< as the filter has it
};

/// The state of a filter at the end of an outage.
struct OutageEnd {
  OutageMoment at;
  Eigen::Matrix<double, 9, 9> covariance = Eigen::Matrix<double, 9, 9>::Zero();  ///< of position, velocity and attitude
  double heading_sd_rad = 0.0;
};

/// The antenna's estimate minus the reference, north, east, down [m]; nothing where there is no reference.
[[nodiscard]] std::optional<Vector3> antenna_error(const Drive& drive, const OutageMoment& at);

/// The outage scored against the drive's reference; nothing where there is none at its start or end.
[[nodiscard]] std::optional<DriveOutage> score_outage(const Drive& drive, const FilterOptions& options,
                                                      const Outage& outage, const OutageStart& start,
                                                      const OutageEnd& end);

/// The reference at a moment, linear between its points; nothing where no points lie within 1.6 s on both sides.
[[nodiscard]] std::optional<Vector3> reference_at(const std::vector<ReferencePoint>& reference, double time_s);

}  // namespace driftlab::drive
