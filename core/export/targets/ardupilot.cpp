#include "core/export/target.hpp"

#include <cmath>

namespace driftlab {
namespace {

constexpr double kStep = 0.012;  // [s], the step that EKF3 aims at

/// A step adds (number * step)^2 to the variance of the angle or velocity, and of the bias: N^2 step and K^2 step where
/// the number is the density over sqrt(step).
std::vector<ExportEntry> entries(const ImuNoise& imu) {
  const double per_step = 1.0 / std::sqrt(kStep);
  return {
      {.key = "EK3_GYRO_P_NSE",
       .figures = {largest(imu.gyroscope, &AxisNoise::density).scaled(per_step)},
       .unit = "rad/s",
       .what = "Gyroscope noise of a step"},
      {.key = "EK3_ACC_P_NSE",
       .figures = {largest(imu.accelerometer, &AxisNoise::density).scaled(per_step)},
       .unit = "m/s^2",
       .what = "Accelerometer noise of a step"},
      {.key = "EK3_GBIAS_P_NSE",
       .figures = {largest(imu.gyroscope, &AxisNoise::walk).scaled(per_step)},
       .unit = "rad/s^2",
       .what = "Gyroscope bias, rate of a step"},
      {.key = "EK3_ABIAS_P_NSE",
       .figures = {largest(imu.accelerometer, &AxisNoise::walk).scaled(per_step)},
       .unit = "m/s^3",
       .what = "Accelerometer bias, rate of a step"},
  };
}

}  // namespace

ExportTarget ardupilot_target() {
  return {.name = "ardupilot",
          .title = "ArduPilot EKF3 parameters",
          .file = "ekf3.param",
          .convention =
              "Numbers of a prediction step of 12 ms: each step adds their square times the step's square (the bias "
              "states are "
              "bias times step). This is the sensor at rest; vibration in flight adds more, which ArduPilot's defaults "
              "allow "
              "for.",
          .source = "https://github.com/ArduPilot/ardupilot, libraries/AP_NavEKF3/AP_NavEKF3_core.cpp",
          .syntax = ExportSyntax::ParameterPairs,
          .bias = BiasModel::Walk,
          .entries = entries};
}

}  // namespace driftlab
