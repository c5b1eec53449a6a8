/// The smoothed path of a recorded drive as a table, in the units of its column names.
#include "core/analysis/drive.hpp"
#include "core/navigate/drive/smoother.hpp"
#include "core/signal/angle.hpp"

#include <cmath>

namespace driftlab {

Result<SampleTable> smoothed_table(const drive::Drive& drive, const drive::FilterOptions& options) {
  const auto prepared = drive::PreparedDrive::make(drive, options);
  if (!prepared) {
    return fail(prepared.error());
  }
  SampleTable table;
  table.columns = {"t [s]",      "lat [deg]",   "lon [deg]", "height [m]", "vn [m/s]", "ve [m/s]", "vd [m/s]",
                   "roll [deg]", "pitch [deg]", "yaw [deg]", "sn [m]",     "se [m]",   "sd [m]",   "s_yaw [deg]"};
  table.decimals = {6, 10, 10, 4, 5, 5, 5, 5, 5, 5, 4, 4, 4, 5};
  for (const drive::FilterTape::Point& point : drive::smoothed_path(*prepared)) {
    const Geodetic place = to_geodetic(point.state.position_ecef_m);
    const Matrix3 axes = ned_axes(place.latitude_rad, place.longitude_rad);
    const Vector3 v = axes.transpose() * point.state.velocity_ecef_m_s;
    const EulerAngles angles = to_euler(Quaternion(axes).conjugate() * point.state.attitude);
    const Matrix3 position = axes.transpose() * point.covariance.topLeftCorner<3, 3>() * axes;
    const Matrix3 attitude = axes.transpose() * point.covariance.bottomRightCorner<3, 3>() * axes;
    const auto sd = [](double variance) { return std::sqrt(std::max(variance, 0.0)); };
    table.values.insert(
        table.values.end(),
        {drive.epoch_s + point.time_s, place.latitude_rad / kDegree, place.longitude_rad / kDegree, place.height_m,
         v.x(), v.y(), v.z(), angles.roll_rad / kDegree, angles.pitch_rad / kDegree, angles.heading_rad / kDegree,
         sd(position(0, 0)), sd(position(1, 1)), sd(position(2, 2)), sd(attitude(2, 2)) / kDegree});
  }
  return table;
}

}  // namespace driftlab
