#pragma once
/// The messages of ROS that a journey consists of, whatever file holds them. Internal to core/read.
///
/// sensor_msgs/Imu has a stamp, an orientation, an angular rate [rad/s], an acceleration [m/s^2] that includes gravity,
/// and a covariance behind each, whose first element is -1 where the sensor does not measure that quantity.
/// sensor_msgs/NavSatFix has a status, latitude and longitude [deg], a height above the ellipsoid [m] and the
/// covariance of the position, east, north, up [m^2]. nav_msgs/Odometry has a pose in a frame of the robot's start and
/// a twist, a velocity [m/s] and a rate [rad/s], in the frame of the robot. Sources: ROS wiki, "sensor_msgs" and
/// "nav_msgs" ("Imu", "NavSatFix", "NavSatStatus", "Odometry") and "Serialization"; OMG DDS-XTypes 1.3, section 7.4
/// (CDR, encapsulation).
#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

namespace driftlab {

enum class RosEncoding { Ros1, Cdr };

struct RosImu {
  std::uint64_t stamp_ns = 0;
  std::array<double, 3> gyro_rad_s{};
  std::array<double, 3> accel_m_s2{};
  bool measures_gyro = true;
  bool measures_accel = true;
};

struct RosFix {
  std::uint64_t stamp_ns = 0;
  int status = 0;  ///< -1: no fix; 0: a fix; 1, 2: augmented from satellites, from the ground
  double latitude_deg = 0.0;
  double longitude_deg = 0.0;
  double height_m = 0.0;
  /// Standard deviations east, north, up [m]; NaN where the receiver states none.
  std::array<double, 3> sd_m{};
};

struct RosOdometry {
  std::uint64_t stamp_ns = 0;
  std::array<double, 3> position_m{};
  std::array<double, 3> velocity_m_s{};  ///< along the robot's own axes
  std::array<double, 3> rate_rad_s{};
};

/// Nothing where `message` is not a whole message of that type in this encoding.
[[nodiscard]] std::optional<RosImu> read_ros_imu(std::string_view message, RosEncoding encoding);
[[nodiscard]] std::optional<RosFix> read_ros_fix(std::string_view message, RosEncoding encoding);
[[nodiscard]] std::optional<RosOdometry> read_ros_odometry(std::string_view message, RosEncoding encoding);

}  // namespace driftlab
