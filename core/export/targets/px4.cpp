#include "core/export/target.hpp"

#include <cmath>

namespace driftlab {
namespace {

constexpr double kStep = 0.010;  // [s], EKF2_PREDICT_US as it comes

/// A step adds (number * step)^2 to the variance of the angle or velocity, and of the bias: N^2 step and K^2 step where
/// the number is the density over sqrt(step).
std::vector<ExportEntry> entries(const ImuNoise& imu) {
  const double per_step = 1.0 / std::sqrt(kStep);
  return {
      {.key = "EKF2_GYR_NOISE",
       .figures = {largest(imu.gyroscope, &AxisNoise::density).scaled(per_step)},
       .unit = "rad/s",
       .what = "Gyroscope noise of a step"},
      {.key = "EKF2_ACC_NOISE",
       .figures = {largest(imu.accelerometer, &AxisNoise::density).scaled(per_step)},
       .unit = "m/s^2",
       .what = "Accelerometer noise of a step"},
      {.key = "EKF2_GYR_B_NOISE",
       .figures = {largest(imu.gyroscope, &AxisNoise::walk).scaled(per_step)},
       .unit = "rad/s^2",
       .what = "Gyroscope bias, rate of a step"},
      {.key = "EKF2_ACC_B_NOISE",
       .figures = {largest(imu.accelerometer, &AxisNoise::walk).scaled(per_step)},
       .unit = "m/s^3",
       .what = "Accelerometer bias, rate of a step"},
  };
}

}  // namespace

ExportTarget px4_target() {
  return {.name = "px4",
          .title = "PX4 EKF2 parameters",
          .file = "ekf2.params",
          .convention =
              "Numbers of a prediction step of 10 ms (EKF2_PREDICT_US as it comes): each step adds their square times "
              "the step's "
              "square. This is the sensor at rest; vibration in flight adds more, which PX4's defaults allow for.",
          .source = "https://github.com/PX4/PX4-Autopilot, src/modules/ekf2/EKF/covariance.cpp",
          .syntax = ExportSyntax::ParameterRows,
          .bias = BiasModel::Walk,
          .entries = entries};
}

}  // namespace driftlab
