#include "core/navigate/drive/filter_options.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace driftlab::drive {

double shaken_share(const FilterOptions& options, std::size_t channel) {
  return std::clamp(channel < 3 ? options.gyro_vibration : options.force_vibration, 0.0, kMostShaken);
}

double shaken_over_even(const FilterOptions& options, std::size_t channel) {
  const double share = shaken_share(options, channel);
  return share / (1.0 - share);
}

void scale_white_noise(AxisModel& axis, double factor) {
  if (factor == 1.0) {
    return;
  }
  std::vector<Model> bands;
  for (std::size_t band = 0; band < axis.processes.size(); ++band) {
    bands.push_back(axis.processes.model(band));
    for (Process& process : bands.back()) {
      if (process.kind->white_square != nullptr) {
        process.parameters[0] *= factor;
      }
    }
  }
  axis.processes =
      *ModelSchedule::by_rate(axis.processes.bounds_rad_s(), std::move(bands), axis.processes.hysteresis_rad_s());
}

double even_noise_factor(const FilterOptions& options, std::size_t channel) {
  return (channel < 3 ? options.gyro_noise : options.force_noise) * std::sqrt(1.0 - shaken_share(options, channel));
}

double noise_after_correction(const ReadingErrors& errors, std::size_t channel) {
  const Matrix3& own = channel < 3 ? errors.gyroscope : errors.accelerometer;
  if (own.isZero(0.0)) {
    return 1.0;
  }
  return (Matrix3::Identity() + own).inverse().row(static_cast<Eigen::Index>(channel % 3)).norm();
}

double velocity_mean_s(const FilterOptions& options) {
  const double older = std::max(options.velocity_latency_s - options.position_latency_s, 0.0);
  return 2.0 * older * std::sqrt(std::max(options.velocity_averaging, 0.0));
}

FilterOptions options_of(const Document& document) {
  FilterOptions options;
  options.lever_arm_m = document.gnss.lever_arm_m;
  options.position_latency_s = document.gnss.position_latency_s;
  options.velocity_latency_s = document.gnss.velocity_latency_s;
  return options;
}

void add_vibration_noise(const Vibration& vibration, const FilterOptions& options, const ImuModel& model, double dt_s,
                         Random& random, std::vector<ImuSample>& readings) {
  for (std::size_t i = 0; i < readings.size(); ++i) {
    const auto& relative = vibration.at(i);
    for (std::size_t c = 0; c < kImuChannels; ++c) {
      const double variance = shaken_over_even(options, c) * white_square_of(model.axes[c]) * relative[c] / dt_s;
      readings[i][c] += std::sqrt(variance) * random.normal();
    }
  }
}

std::vector<ImuSample> corrected_readings(const UniformRun& run, const ReadingErrors& errors) {
  std::vector<ImuSample> readings = run.readings;
  if (errors.none()) {
    return readings;
  }
  const Matrix3 gyroscope = (Matrix3::Identity() + errors.gyroscope).inverse();
  const Matrix3 accelerometer = (Matrix3::Identity() + errors.accelerometer).inverse();
  for (ImuSample& sample : readings) {
    const Vector3 rate = gyroscope * Vector3(sample[0], sample[1], sample[2]);
    const Vector3 force = accelerometer * Vector3(sample[3], sample[4], sample[5]);
    sample = {rate.x(), rate.y(), rate.z(), force.x(), force.y(), force.z()};
  }
  return readings;
}

}  // namespace driftlab::drive
