#include "core/export/target.hpp"

#include <cmath>

namespace driftlab {
namespace {

/// The root density of the noise that drives a first-order Gauss-Markov process: sqrt(2 sigma^2 / T).
std::vector<NoiseFigure> driving(const SensorNoise& sensor) {
  std::vector<NoiseFigure> figures = by_axis(sensor, &AxisNoise::bias_sd);
  const std::vector<NoiseFigure> times = by_axis(sensor, &AxisNoise::correlation_s);
  for (std::size_t i = 0; i < figures.size(); ++i) {
    const std::optional<double>& time_s = times[i].value;
    figures[i] = figures[i].scaled(time_s ? std::sqrt(2.0 / *time_s) : 1.0);
  }
  return figures;
}

std::vector<ExportEntry> entries(const ImuNoise& imu) {
  return {
      {.key = "imu.arw",
       .figures = by_axis(imu.gyroscope, &AxisNoise::density),
       .list = true,
       .unit = "rad/s/sqrt(Hz)",
       .what = "Angle random walk"},
      {.key = "imu.vrw",
       .figures = by_axis(imu.accelerometer, &AxisNoise::density),
       .list = true,
       .unit = "m/s^2/sqrt(Hz)",
       .what = "Velocity random walk"},
      {.key = "imu.gb_dyn",
       .figures = by_axis(imu.gyroscope, &AxisNoise::bias_sd),
       .list = true,
       .unit = "rad/s",
       .what = "Standard deviation of the gyroscope bias"},
      {.key = "imu.ab_dyn",
       .figures = by_axis(imu.accelerometer, &AxisNoise::bias_sd),
       .list = true,
       .unit = "m/s^2",
       .what = "Standard deviation of the accelerometer bias"},
      {.key = "imu.gb_corr",
       .figures = by_axis(imu.gyroscope, &AxisNoise::correlation_s),
       .list = true,
       .unit = "s",
       .what = "Correlation time of the gyroscope bias"},
      {.key = "imu.ab_corr",
       .figures = by_axis(imu.accelerometer, &AxisNoise::correlation_s),
       .list = true,
       .unit = "s",
       .what = "Correlation time of the accelerometer bias"},
      {.key = "imu.gb_psd",
       .figures = driving(imu.gyroscope),
       .list = true,
       .unit = "rad/s^2/sqrt(Hz)",
       .what = "Root density that drives the gyroscope bias"},
      {.key = "imu.ab_psd",
       .figures = driving(imu.accelerometer),
       .list = true,
       .unit = "m/s^3/sqrt(Hz)",
       .what = "Root density that drives the accelerometer bias"},
      {.key = "imu.freq",
       .figures = {{imu.rate_hz, {}, {}, false, "rate of the recording"}},
       .unit = "Hz",
       .what = "Rate of the readings"},
  };
}

}  // namespace

ExportTarget navego_target() {
  return {
      .name = "navego",
      .title = "NaveGo imu structure (MATLAB)",
      .file = "navego_imu.m",
      .convention =
          "SI units, as ins_gnss takes them: do not pass this structure through imu_si_errors. Biases are first-order "
          "Gauss-Markov; the filter's Q holds the squares of arw, vrw, gb_psd and ab_psd, where psd is the root "
          "density "
          "that drives the bias, sqrt(2/T) times its standard deviation (imu_si_errors leaves the 2 out).",
      .source = "https://github.com/rodralez/NaveGo, conversions/imu_si_errors.m and ins-gnss/ins_gnss.m",
      .syntax = ExportSyntax::Matlab,
      .bias = BiasModel::Markov,
      .entries = entries};
}

}  // namespace driftlab
