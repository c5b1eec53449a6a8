#include "core/export/target.hpp"

namespace driftlab {
namespace {

/// A 3 x 3 covariance by rows with the variance of one reading on its diagonal.
std::vector<NoiseFigure> covariance(const SensorNoise& sensor, double rate_hz) {
  std::vector<NoiseFigure> matrix(9, NoiseFigure{0.0, {}, {}, false, ""});
  const std::vector<NoiseFigure> axes = by_axis(sensor, &AxisNoise::density);
  for (std::size_t i = 0; i < axes.size(); ++i) {
    matrix[4 * i] = axes[i].squared().scaled(rate_hz);
  }
  return matrix;
}

std::vector<ExportEntry> entries(const ImuNoise& imu) {
  return {
      {.key = "angular_velocity_covariance",
       .figures = covariance(imu.gyroscope, imu.rate_hz),
       .list = true,
       .unit = "(rad/s)^2",
       .what = "For the field of the same name of sensor_msgs/Imu, by rows"},
      {.key = "linear_acceleration_covariance",
       .figures = covariance(imu.accelerometer, imu.rate_hz),
       .list = true,
       .unit = "(m/s^2)^2",
       .what = "For the field of the same name of sensor_msgs/Imu, by rows"},
  };
}

}  // namespace

ExportTarget robot_localization_target() {
  return {
      .name = "robot-localization",
      .title = "robot_localization: covariances of the messages sensor_msgs/Imu",
      .file = "imu_covariances.yaml",
      .convention =
          "The filter takes the noise of a reading from its message: variances at the rate of the recording, N^2 * "
          "rate. It "
          "has no states for biases, so that a bias that moves has no place in it. process_noise_covariance is how the "
          "vehicle moves, no property of the sensor.",
      .source = "http://docs.ros.org/en/noetic/api/robot_localization/html/preparing_sensor_data.html",
      .syntax = ExportSyntax::Yaml,
      .bias = BiasModel::None,
      .entries = entries};
}

}  // namespace driftlab
