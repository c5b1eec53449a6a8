#include "core/export/target.hpp"

namespace driftlab {
namespace {

NoiseFigure nothing() { return {0.0, {}, {}, false, "constant biases are not noise"}; }

std::vector<ExportEntry> entries(const ImuNoise& imu) {
  return {
      {.key = "gyro_b",
       .figures = {nothing(), nothing(), nothing()},
       .list = true,
       .unit = "deg/h",
       .what = "Constant gyroscope bias"},
      {.key = "gyro_arw",
       .figures = scaled(by_axis(imu.gyroscope, &AxisNoise::density), kDegreesPerRootHour),
       .list = true,
       .unit = "deg/sqrt(h)",
       .what = "Angle random walk"},
      {.key = "gyro_b_stability",
       .figures = scaled(by_axis(imu.gyroscope, &AxisNoise::bias_sd), kDegreesPerHour),
       .list = true,
       .unit = "deg/h",
       .what = "Standard deviation of the gyroscope bias"},
      {.key = "gyro_b_corr",
       .figures = by_axis(imu.gyroscope, &AxisNoise::correlation_s),
       .list = true,
       .unit = "s",
       .what = "Correlation time of the gyroscope bias"},
      {.key = "accel_b",
       .figures = {nothing(), nothing(), nothing()},
       .list = true,
       .unit = "m/s^2",
       .what = "Constant accelerometer bias"},
      {.key = "accel_vrw",
       .figures = scaled(by_axis(imu.accelerometer, &AxisNoise::density), kMetresPerSecondPerRootHour),
       .list = true,
       .unit = "m/s/sqrt(h)",
       .what = "Velocity random walk"},
      {.key = "accel_b_stability",
       .figures = by_axis(imu.accelerometer, &AxisNoise::bias_sd),
       .list = true,
       .unit = "m/s^2",
       .what = "Standard deviation of the accelerometer bias"},
      {.key = "accel_b_corr",
       .figures = by_axis(imu.accelerometer, &AxisNoise::correlation_s),
       .list = true,
       .unit = "s",
       .what = "Correlation time of the accelerometer bias"},
  };
}

}  // namespace

ExportTarget gnss_ins_sim_target() {
  return {
      .name = "gnss-ins-sim",
      .title = "gnss-ins-sim imu_err (Python)",
      .file = "gnss_ins_sim_imu.py",
      .convention =
          "b_stability is the standard deviation of a first-order Gauss-Markov bias and b_corr its correlation time "
          "(releases before issue 19 drove it with another level).",
      .source = "https://github.com/Aceinna/gnss-ins-sim, gnss_ins_sim/sim/imu_model.py and pathgen/pathgen.py",
      .syntax = ExportSyntax::PythonDict,
      .bias = BiasModel::Markov,
      .prologue = "import numpy as np\n\nimu_err = {\n",
      .epilogue = "}\n",
      .entries = entries};
}

}  // namespace driftlab
