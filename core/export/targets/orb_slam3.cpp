#include "core/export/target.hpp"

namespace driftlab {
namespace {

std::vector<ExportEntry> entries(const ImuNoise& imu) {
  return {
      {.key = "IMU.NoiseGyro",
       .figures = {largest(imu.gyroscope, &AxisNoise::density)},
       .unit = "rad/s/sqrt(Hz)",
       .what = "Gyroscope noise density"},
      {.key = "IMU.NoiseAcc",
       .figures = {largest(imu.accelerometer, &AxisNoise::density)},
       .unit = "m/s^2/sqrt(Hz)",
       .what = "Accelerometer noise density"},
      {.key = "IMU.GyroWalk",
       .figures = {largest(imu.gyroscope, &AxisNoise::walk)},
       .unit = "rad/s^2/sqrt(Hz)",
       .what = "Gyroscope bias random walk"},
      {.key = "IMU.AccWalk",
       .figures = {largest(imu.accelerometer, &AxisNoise::walk)},
       .unit = "m/s^3/sqrt(Hz)",
       .what = "Accelerometer bias random walk"},
      {.key = "IMU.Frequency",
       .figures = {{imu.rate_hz, {}, {}, false, "rate of the recording"}},
       .unit = "Hz",
       .what = "Rate of the readings"},
  };
}

}  // namespace

ExportTarget orb_slam3_target() {
  return {.name = "orb-slam3",
          .title = "ORB-SLAM3 settings (the part that names the IMU)",
          .file = "orb_slam3_imu.yaml",
          .convention =
              "Densities of continuous time; the program multiplies the noises by sqrt(IMU.Frequency) and divides the "
              "walks "
              "by it.",
          .source = "https://github.com/UZ-SLAMLab/ORB_SLAM3, Calibration_Tutorial.pdf",
          .syntax = ExportSyntax::Yaml,
          .bias = BiasModel::Walk,
          .first_line = "%YAML:1.0",
          .entries = entries};
}

}  // namespace driftlab
