#include "core/export/target.hpp"

#include <cmath>

namespace driftlab {
namespace {

/// Madgwick 2010, eqs. (50) and (51): gains sqrt(3/4) times the error of a reading and its rate of change.
std::vector<ExportEntry> entries(const ImuNoise& imu) {
  const double gain = std::sqrt(0.75 * imu.rate_hz);
  return {
      {.key = "imu_filter_madgwick_node/ros__parameters/gain",
       .figures = {largest(imu.gyroscope, &AxisNoise::density).scaled(gain)},
       .unit = "rad/s",
       .what = "Error of a gyroscope reading times sqrt(3/4)"},
      {.key = "imu_filter_madgwick_node/ros__parameters/zeta",
       .figures = {largest(imu.gyroscope, &AxisNoise::walk).scaled(gain)},
       .unit = "rad/s^2",
       .what = "Rate of the gyroscope bias from reading to reading times sqrt(3/4)"},
  };
}

}  // namespace

ExportTarget imu_tools_target() {
  return {.name = "imu-tools",
          .title = "imu_tools, imu_filter_madgwick parameters (ROS 2)",
          .file = "imu_filter_madgwick.yaml",
          .convention =
              "The filter corrects by gain a second along one direction and the bias by zeta a second: the rates at "
              "which a "
              "reading's white noise and the bias err, at the rate of the recording. They are the least gains that "
              "follow this "
              "sensor; a start from a wrong attitude converges sooner with more.",
          .source =
              "S. Madgwick, An efficient orientation filter for inertial and inertial/magnetic sensor arrays (2010), "
              "section 3.6",
          .syntax = ExportSyntax::Yaml,
          .bias = BiasModel::Walk,
          .entries = entries};
}

}  // namespace driftlab
