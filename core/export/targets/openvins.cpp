#include "core/export/target.hpp"

namespace driftlab {
namespace {

constexpr const char* kIdentity = "[[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]";

std::vector<ExportEntry> entries(const ImuNoise& imu) {
  return {
      {.key = "imu0/T_i_b",
       .text = "[[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]]",
       .what = "Pose of the body in the IMU; change it to yours"},
      {.key = "imu0/accelerometer_noise_density",
       .figures = {largest(imu.accelerometer, &AxisNoise::density)},
       .unit = "m/s^2/sqrt(Hz)",
       .what = "Accelerometer noise density"},
      {.key = "imu0/accelerometer_random_walk",
       .figures = {largest(imu.accelerometer, &AxisNoise::walk)},
       .unit = "m/s^3/sqrt(Hz)",
       .what = "Accelerometer bias random walk"},
      {.key = "imu0/gyroscope_noise_density",
       .figures = {largest(imu.gyroscope, &AxisNoise::density)},
       .unit = "rad/s/sqrt(Hz)",
       .what = "Gyroscope noise density"},
      {.key = "imu0/gyroscope_random_walk",
       .figures = {largest(imu.gyroscope, &AxisNoise::walk)},
       .unit = "rad/s^2/sqrt(Hz)",
       .what = "Gyroscope bias random walk"},
      {.key = "imu0/model", .text = "kalibr", .what = "Scale and misalignment below; noise says nothing about them"},
      {.key = "imu0/Tw", .text = kIdentity},
      {.key = "imu0/R_IMUtoGYRO", .text = kIdentity},
      {.key = "imu0/Ta", .text = kIdentity},
      {.key = "imu0/R_IMUtoACC", .text = kIdentity},
      {.key = "imu0/Tg", .text = "[[0.0, 0.0, 0.0], [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]]"},
      {.key = "imu0/rostopic", .text = "/imu0", .what = "Topic; change it to yours"},
      {.key = "imu0/time_offset",
       .figures = {{0.0, {}, {}, false, "not of this recording"}},
       .unit = "s",
       .what = "Camera against IMU"},
      {.key = "imu0/update_rate",
       .figures = {{imu.rate_hz, {}, {}, false, "rate of the recording"}},
       .unit = "Hz",
       .what = "Rate of the readings"},
  };
}

}  // namespace

ExportTarget openvins_target() {
  return {.name = "openvins",
          .title = "OpenVINS kalibr_imu_chain.yaml",
          .file = "kalibr_imu_chain.yaml",
          .convention =
              "Densities of continuous time, as in Kalibr's files; the propagation divides the square of the noise by "
              "the step "
              "and multiplies that of the walk by it.",
          .source = "https://docs.openvins.com/propagation.html",
          .syntax = ExportSyntax::Yaml,
          .bias = BiasModel::Walk,
          .first_line = "%YAML:1.0",
          .entries = entries};
}

}  // namespace driftlab
