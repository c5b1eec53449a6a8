#include "core/export/target.hpp"

namespace driftlab {
namespace {

std::vector<ExportEntry> entries(const ImuNoise& imu) {
  return {
      {.key = "accelerometer_noise_density",
       .figures = {largest(imu.accelerometer, &AxisNoise::density)},
       .unit = "m/s^2/sqrt(Hz)",
       .what = "Accelerometer noise density"},
      {.key = "accelerometer_random_walk",
       .figures = {largest(imu.accelerometer, &AxisNoise::walk)},
       .unit = "m/s^3/sqrt(Hz)",
       .what = "Accelerometer bias random walk"},
      {.key = "gyroscope_noise_density",
       .figures = {largest(imu.gyroscope, &AxisNoise::density)},
       .unit = "rad/s/sqrt(Hz)",
       .what = "Gyroscope noise density"},
      {.key = "gyroscope_random_walk",
       .figures = {largest(imu.gyroscope, &AxisNoise::walk)},
       .unit = "rad/s^2/sqrt(Hz)",
       .what = "Gyroscope bias random walk"},
      {.key = "rostopic", .text = "/imu0", .what = "Topic of the bag; change it to yours"},
      {.key = "update_rate",
       .figures = {{imu.rate_hz, {}, {}, false, "rate of the recording"}},
       .unit = "Hz",
       .what = "Rate of the readings"},
  };
}

}  // namespace

ExportTarget kalibr_target() {
  return {.name = "kalibr",
          .title = "Kalibr imu.yaml",
          .file = "imu.yaml",
          .convention =
              "Densities of continuous time: a reading's white noise has the standard deviation density * "
              "sqrt(update_rate), "
              "and the bias moves by walk / sqrt(update_rate) from one reading to the next.",
          .source = "https://github.com/ethz-asl/kalibr/wiki/IMU-Noise-Model",
          .syntax = ExportSyntax::Yaml,
          .bias = BiasModel::Walk,
          .entries = entries};
}

}  // namespace driftlab
