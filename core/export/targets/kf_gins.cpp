#include "core/export/target.hpp"

#include <cmath>

namespace driftlab {
namespace {

constexpr double kMilligalPerSi = 1e5;  // 1 mGal = 1e-5 m/s^2

/// One correlation time serves all axes of both sensors: the geometric mean of theirs.
NoiseFigure common_time(const ImuNoise& imu) {
  double logs = 0.0;
  int count = 0;
  for (const SensorNoise* sensor : {&imu.gyroscope, &imu.accelerometer}) {
    for (const AxisNoise& axis : sensor->axes) {
      if (axis.correlation_s.value) {
        logs += std::log(*axis.correlation_s.value);
        ++count;
      }
    }
  }
  NoiseFigure figure;
  if (count == 0) {
    figure.remark = imu.gyroscope.axes.empty() ? imu.accelerometer.axes.front().correlation_s.remark
                                               : imu.gyroscope.axes.front().correlation_s.remark;
    return figure;
  }
  figure.value = std::exp(logs / count);
  figure.remark = "geometric mean over " + std::to_string(count) + " axes";
  return figure;
}

/// Standard deviations that drive the bias as each axis's own correlation time does: 2 sigma^2 / T stays what it is.
SensorNoise retimed(SensorNoise sensor, const NoiseFigure& common) {
  for (AxisNoise& axis : sensor.axes) {
    if (axis.bias_sd.value && axis.correlation_s.value && common.value) {
      axis.bias_sd = axis.bias_sd.scaled(std::sqrt(*common.value / *axis.correlation_s.value));
    }
  }
  return sensor;
}

std::vector<ExportEntry> entries(const ImuNoise& imu) {
  const NoiseFigure time = common_time(imu);
  const SensorNoise gyroscope = retimed(imu.gyroscope, time);
  const SensorNoise accelerometer = retimed(imu.accelerometer, time);
  return {
      {.key = "imunoise/arw",
       .figures = scaled(by_axis(gyroscope, &AxisNoise::density), kDegreesPerRootHour),
       .list = true,
       .unit = "deg/sqrt(h)",
       .what = "Angle random walk"},
      {.key = "imunoise/vrw",
       .figures = scaled(by_axis(accelerometer, &AxisNoise::density), kMetresPerSecondPerRootHour),
       .list = true,
       .unit = "m/s/sqrt(h)",
       .what = "Velocity random walk"},
      {.key = "imunoise/gbstd",
       .figures = scaled(by_axis(gyroscope, &AxisNoise::bias_sd), kDegreesPerHour),
       .list = true,
       .unit = "deg/h",
       .what = "Standard deviation of the gyroscope bias"},
      {.key = "imunoise/abstd",
       .figures = scaled(by_axis(accelerometer, &AxisNoise::bias_sd), kMilligalPerSi),
       .list = true,
       .unit = "mGal",
       .what = "Standard deviation of the accelerometer bias"},
      {.key = "imunoise/gsstd",
       .text = "[300.0, 300.0, 300.0]",
       .what = "Gyroscope scale factor [ppm]: no recording at rest shows it; the program's own example"},
      {.key = "imunoise/asstd",
       .text = "[300.0, 300.0, 300.0]",
       .what = "Accelerometer scale factor [ppm]: no recording at rest shows it; the program's own example"},
      {.key = "imunoise/corrtime",
       .figures = {time.scaled(1.0 / 3600.0)},
       .unit = "h",
       .what = "Correlation time of all biases"},
  };
}

}  // namespace

ExportTarget kf_gins_target() {
  return {
      .name = "kf-gins",
      .title = "KF-GINS configuration (the part imunoise)",
      .file = "kf-gins-imunoise.yaml",
      .convention =
          "Biases are first-order Gauss-Markov with one correlation time; the process noise of a bias is 2 std^2 / "
          "corrtime. Where axes differ in correlation time their standard deviation is set so that this stays theirs.",
      .source = "https://github.com/i2Nav-WHU/KF-GINS, dataset/kf-gins.yaml and src/kf-gins/gi_engine.cpp",
      .syntax = ExportSyntax::Yaml,
      .bias = BiasModel::Markov,
      .entries = entries};
}

}  // namespace driftlab
