#include "core/export/target.hpp"

#include <cmath>

namespace driftlab {
namespace {

/// The preintegration adds V Q V' a step, whose rows for the bias are the step dt and whose Q is the square of these
/// numbers: the bias moves by acc_w dt a step, K sqrt(dt) where acc_w = K / sqrt(dt). Readings count with their own
/// deviation.
std::vector<ExportEntry> entries(const ImuNoise& imu) {
  const double root_rate = std::sqrt(imu.rate_hz);
  return {
      {.key = "acc_n",
       .figures = {largest(imu.accelerometer, &AxisNoise::density).scaled(root_rate)},
       .unit = "m/s^2",
       .what = "Standard deviation of an accelerometer reading"},
      {.key = "gyr_n",
       .figures = {largest(imu.gyroscope, &AxisNoise::density).scaled(root_rate)},
       .unit = "rad/s",
       .what = "Standard deviation of a gyroscope reading"},
      {.key = "acc_w",
       .figures = {largest(imu.accelerometer, &AxisNoise::walk).scaled(root_rate)},
       .unit = "m/s^3",
       .what = "Rate at which the accelerometer bias moves within a step"},
      {.key = "gyr_w",
       .figures = {largest(imu.gyroscope, &AxisNoise::walk).scaled(root_rate)},
       .unit = "rad/s^2",
       .what = "Rate at which the gyroscope bias moves within a step"},
  };
}

}  // namespace

ExportTarget vins_fusion_target() {
  return {
      .name = "vins-fusion",
      .title = "VINS-Fusion and VINS-Mono configuration (the part that names the IMU)",
      .file = "vins_imu.yaml",
      .convention =
          "Deviations at the rate of the IMU, no densities: acc_n and gyr_n of one reading, acc_w and gyr_w such that "
          "the "
          "bias moves by w times the step. Export again for another rate.",
      .source = "https://github.com/HKUST-Aerial-Robotics/VINS-Fusion, vins_estimator/src/factor/integration_base.h",
      .syntax = ExportSyntax::Yaml,
      .bias = BiasModel::Walk,
      .first_line = "%YAML:1.0",
      .entries = entries};
}

}  // namespace driftlab
