#include "core/export/target.hpp"

#include <cmath>

namespace driftlab {
namespace {

void add_sensor(const SensorNoise& sensor, const std::string& group, const std::string& unit, double rate_hz,
                std::vector<ExportEntry>& entries) {
  const std::vector<NoiseFigure> density = by_axis(sensor, &AxisNoise::density);
  const std::vector<NoiseFigure> deviation = by_axis(sensor, &AxisNoise::bias_sd);
  const std::vector<NoiseFigure> time = by_axis(sensor, &AxisNoise::correlation_s);
  const char* const names[] = {"x", "y", "z"};
  for (std::size_t i = 0; i < 3; ++i) {
    const std::string noise = "imu/" + group + "/" + names[i] + "/noise type=\"gaussian\"/";
    const std::optional<double>& time_s = time[i].value;
    const double driving = time_s ? std::sqrt(2.0 / *time_s) : 1.0;
    entries.push_back({.key = noise + "mean", .figures = {{0.0, {}, {}, false, ""}}, .unit = unit, .what = ""});
    entries.push_back({.key = noise + "stddev",
                       .figures = {density[i].scaled(std::sqrt(rate_hz))},
                       .unit = unit,
                       .what = "White noise of a reading"});
    entries.push_back({.key = noise + "dynamic_bias_stddev",
                       .figures = {deviation[i].scaled(driving)},
                       .unit = unit + "/s/sqrt(Hz)",
                       .what = "Density that drives the bias"});
    entries.push_back({.key = noise + "dynamic_bias_correlation_time",
                       .figures = {time[i]},
                       .unit = "s",
                       .what = "Correlation time of the bias"});
  }
}

std::vector<ExportEntry> entries(const ImuNoise& imu) {
  std::vector<ExportEntry> all;
  add_sensor(imu.gyroscope, "angular_velocity", "rad/s", imu.rate_hz, all);
  add_sensor(imu.accelerometer, "linear_acceleration", "m/s^2", imu.rate_hz, all);
  return all;
}

}  // namespace

ExportTarget gazebo_target() {
  return {
      .name = "gazebo",
      .title = "Gazebo (gz-sensors) noise of an imu sensor (SDF)",
      .file = "imu_noise.sdf",
      .convention =
          "stddev is that of one reading, at the update_rate of the recording. dynamic_bias_stddev is the density that "
          "drives "
          "a first-order Gauss-Markov bias, not the deviation of the bias: that is dynamic_bias_stddev * sqrt(T/2).",
      .source = "https://github.com/gazebosim/gz-sensors, src/GaussianNoiseModel.cc",
      .syntax = ExportSyntax::Xml,
      .bias = BiasModel::Markov,
      .entries = entries};
}

}  // namespace driftlab
