#include "core/export/target.hpp"

#include <cmath>

namespace driftlab {
namespace {

std::vector<ExportEntry> entries(const ImuNoise& imu) {
  const double root_rate = std::sqrt(imu.rate_hz);
  return {
      {.key = "GYROSCOPE_STD",
       .figures = {largest(imu.gyroscope, &AxisNoise::density).scaled(root_rate)},
       .unit = "rad/s",
       .what = "White noise of a gyroscope reading"},
      {.key = "GYROSCOPE_BIAS_STD",
       .figures = {largest(imu.gyroscope, &AxisNoise::bias_sd)},
       .unit = "rad/s",
       .what = "Gyroscope bias, drawn at each reset"},
      {.key = "ACCELEROMETER_STD",
       .figures = {largest(imu.accelerometer, &AxisNoise::density).scaled(root_rate)},
       .unit = "m/s^2",
       .what = "White noise of an accelerometer reading"},
      {.key = "ACCELEROMETER_BIAS_STD",
       .figures = {largest(imu.accelerometer, &AxisNoise::bias_sd)},
       .unit = "m/s^2",
       .what = "Accelerometer bias, drawn at each reset"},
  };
}

}  // namespace

ExportTarget isaac_target() {
  return {
      .name = "isaac",
      .title = "Isaac Lab noise models of IMU observations (Python)",
      .file = "isaac_imu_noise.py",
      .convention =
          "Standard deviations of one reading at the rate of the recording, and of a bias that is drawn at each reset "
          "and "
          "stays: it does not move within an episode, so that episodes should be short against the correlation time.",
      .source = "https://isaac-sim.github.io/IsaacLab, isaaclab.utils.noise",
      .syntax = ExportSyntax::PythonNames,
      .bias = BiasModel::Markov,
      .prologue = "from isaaclab.utils.noise import GaussianNoiseCfg, NoiseModelWithAdditiveBiasCfg\n\n",
      .epilogue =
          "\n\ndef noise_model(std, bias_std):\n"
          "    return NoiseModelWithAdditiveBiasCfg(\n"
          "        noise_cfg=GaussianNoiseCfg(mean=0.0, std=std, operation=\"add\"),\n"
          "        bias_noise_cfg=GaussianNoiseCfg(mean=0.0, std=bias_std, operation=\"abs\"),\n"
          "    )\n\n\n"
          "gyroscope_noise = noise_model(GYROSCOPE_STD, GYROSCOPE_BIAS_STD)\n"
          "accelerometer_noise = noise_model(ACCELEROMETER_STD, ACCELEROMETER_BIAS_STD)\n",
      .entries = entries};
}

}  // namespace driftlab
