#include "core/export/target.hpp"

namespace driftlab {
namespace {

std::vector<NoiseFigure> squared(std::vector<NoiseFigure> figures) {
  for (NoiseFigure& figure : figures) {
    figure = figure.squared();
  }
  return figures;
}

std::vector<ExportEntry> entries(const ImuNoise& imu) {
  return {
      {.key = "gyroscopeCovariance",
       .figures = squared(by_axis(imu.gyroscope, &AxisNoise::density)),
       .list = true,
       .unit = "rad^2/s",
       .what = "Gyroscope, white noise N^2"},
      {.key = "accelerometerCovariance",
       .figures = squared(by_axis(imu.accelerometer, &AxisNoise::density)),
       .list = true,
       .unit = "m^2/s^3",
       .what = "Accelerometer, white noise N^2"},
      {.key = "biasOmegaCovariance",
       .figures = squared(by_axis(imu.gyroscope, &AxisNoise::walk)),
       .list = true,
       .unit = "rad^2/s^3",
       .what = "Gyroscope, bias random walk K^2"},
      {.key = "biasAccCovariance",
       .figures = squared(by_axis(imu.accelerometer, &AxisNoise::walk)),
       .list = true,
       .unit = "m^2/s^5",
       .what = "Accelerometer, bias random walk K^2"},
  };
}

}  // namespace

ExportTarget gtsam_target() {
  return {
      .name = "gtsam",
      .title = "GTSAM PreintegrationCombinedParams (C++)",
      .file = "gtsam_imu_noise.hpp",
      .convention =
          "Covariances of continuous time: squares of the densities. The preintegration divides those of the readings "
          "by "
          "the step and multiplies those of the biases by it. PreintegrationParams (without Combined) has the first "
          "two "
          "alone. integrationCovariance is the error of the integration, no noise of the sensor, and stays as it is.",
      .source = "https://github.com/borglab/gtsam, gtsam/navigation/PreintegrationCombinedParams.h",
      .syntax = ExportSyntax::Cpp,
      .bias = BiasModel::Walk,
      .prologue =
          "#pragma once\n#include <gtsam/navigation/CombinedImuFactor.h>\n\n"
          "inline void set_imu_noise(gtsam::PreintegrationCombinedParams& params) {\n",
      .epilogue = "}\n",
      .entries = entries};
}

}  // namespace driftlab
