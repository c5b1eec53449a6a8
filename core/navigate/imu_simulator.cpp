#include "core/navigate/imu_simulator.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

namespace driftlab {
namespace {

/// One process of a schedule whose law is that of a scalar state: y = h x + v, x' = phi x + w.
struct ScalarStep {
  double phi = 0.0;
  double step_sd = 0.0;
  double start_sd = 0.0;
  double white_sd = 0.0;
};

/// The scalar form of process k in every band, or nothing where it has more states or none is exact.
std::optional<std::vector<ScalarStep>> scalar_steps(const ModelSchedule& schedule, std::size_t k, double dt_s) {
  std::vector<ScalarStep> steps;
  for (std::size_t band = 0; band < schedule.size(); ++band) {
    const auto space = schedule.model(band)[k].state_space(dt_s);
    if (!space || space->phi.rows() > 1 || space->relative_error > 0.0) {
      return std::nullopt;
    }
    ScalarStep step;
    step.white_sd = std::sqrt(space->r);
    if (space->phi.rows() == 1) {
      const double gain = space->h(0);
      step.phi = space->phi(0, 0);
      step.step_sd = std::fabs(gain) * std::sqrt(space->q(0, 0));
      step.start_sd = std::fabs(gain) * std::sqrt(space->cov0(0, 0));
    }
    steps.push_back(step);
  }
  return steps;
}

void add_scalar(const std::vector<ScalarStep>& steps, const std::vector<std::size_t>& bands, Random& random,
                std::vector<double>& path) {
  const bool white = std::any_of(steps.begin(), steps.end(), [](const ScalarStep& s) { return s.white_sd > 0.0; });
  const bool wanders =
      std::any_of(steps.begin(), steps.end(), [](const ScalarStep& s) { return s.start_sd > 0.0 || s.step_sd > 0.0; });
  double level = wanders ? steps[bands.front()].start_sd * random.normal() : 0.0;
  for (std::size_t t = 0; t < path.size(); ++t) {
    const ScalarStep& step = steps[bands[t]];
    path[t] += level;
    if (white) {
      path[t] += step.white_sd * random.normal();
    }
    if (wanders) {
      level = step.phi * level + step.step_sd * random.normal();
    }
  }
}

/// Paths of every band from the same draws; each sample is that of its band.
void add_switched(const ModelSchedule& schedule, std::size_t k, const std::vector<std::size_t>& bands, double dt_s,
                  Random& random, std::vector<double>& path) {
  const Random before = random;
  for (std::size_t band = 0; band < schedule.size(); ++band) {
    random = before;
    std::vector<double> whole(path.size(), 0.0);
    schedule.model(band)[k].add_path(random, dt_s, whole);
    for (std::size_t t = 0; t < path.size(); ++t) {
      path[t] += bands[t] == band ? whole[t] : 0.0;
    }
  }
}

/// Second-order Butterworth low-pass in place, bilinear transform with the corner prewarped; settled at its first
/// input.
class LowPass {
 public:
  LowPass(double corner_hz, double dt_s) {
    const double w = std::tan(std::numbers::pi * corner_hz * dt_s);
    const double norm = 1.0 / (1.0 + std::numbers::sqrt2 * w + w * w);
    b_ = w * w * norm;
    a1_ = 2.0 * (w * w - 1.0) * norm;
    a2_ = (1.0 - std::numbers::sqrt2 * w + w * w) * norm;
  }
  double operator()(double x) {
    if (!settled_) {
      x1_ = x2_ = y1_ = y2_ = x;
      settled_ = true;
    }
    const double y = b_ * (x + 2.0 * x1_ + x2_) - a1_ * y1_ - a2_ * y2_;
    x2_ = x1_;
    x1_ = x;
    y2_ = y1_;
    y1_ = y;
    return y;
  }

 private:
  double b_ = 0.0, a1_ = 0.0, a2_ = 0.0;
  double x1_ = 0.0, x2_ = 0.0, y1_ = 0.0, y2_ = 0.0;
  bool settled_ = false;
};

/// Misalignment and scale factor of both triads.
ImuSample distorted(const ImuSample& ideal, const ImuHardware& hardware) {
  ImuSample out = ideal;
  for (std::size_t c = 0; c < kImuChannels; ++c) {
    const std::size_t triad = c < 3 ? 0 : 3;
    const Matrix3& cross = c < 3 ? hardware.gyroscope_misalignment : hardware.accelerometer_misalignment;
    out[c] += hardware.scale_factor[c] * ideal[c];
    for (std::size_t k = 0; k < 3; ++k) {
      out[c] += cross(static_cast<Eigen::Index>(c - triad), static_cast<Eigen::Index>(k)) * ideal[triad + k];
    }
  }
  return out;
}

double electronics(double value, double range, double step) {
  if (range > 0.0) {
    value = std::clamp(value, -range, range);
  }
  return step > 0.0 ? step * std::nearbyint(value / step) : value;
}

void apply_bandwidth(std::vector<ImuSample>& samples, const ImuHardware& hardware, double dt_s) {
  for (std::size_t c = 0; c < kImuChannels; ++c) {
    if (hardware.bandwidth_hz[c] > 0.0 && hardware.bandwidth_hz[c] * dt_s < 0.5) {
      LowPass filter(hardware.bandwidth_hz[c], dt_s);
      for (ImuSample& sample : samples) {
        sample[c] = filter(sample[c]);
      }
    }
  }
}

}  // namespace

Status check(const ImuHardware& hardware) {
  const auto finite = [](const std::array<double, kImuChannels>& values) {
    return std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
  };
  const auto positive = [&](const std::array<double, kImuChannels>& values) {
    return finite(values) && std::all_of(values.begin(), values.end(), [](double v) { return v >= 0.0; });
  };
  const auto bad = [](const char* member) {
    return fail(
        ErrorCode::InvalidArgument,
        "The sensor's " + std::string(member) + " must be finite, and steps, ranges and bandwidths not negative.",
        {{"parameter", member}});
  };
  if (!finite(hardware.bias)) {
    return bad("bias");
  }
  if (!finite(hardware.scale_factor)) {
    return bad("scale_factor");
  }
  if (!hardware.gyroscope_misalignment.allFinite() || !hardware.accelerometer_misalignment.allFinite()) {
    return bad("misalignment");
  }
  if (!positive(hardware.quantization_step)) {
    return bad("quantization_step");
  }
  if (!positive(hardware.range)) {
    return bad("range");
  }
  if (!positive(hardware.bandwidth_hz)) {
    return bad("bandwidth_hz");
  }
  return {};
}

std::vector<double> simulate_axis(const ModelSchedule& schedule, std::span<const double> rates_rad_s, double dt_s,
                                  std::size_t samples, Random& random) {
  if (schedule.size() == 1 || rates_rad_s.empty()) {
    return simulate(schedule.model(0), random, dt_s, samples);
  }
  std::vector<std::size_t> bands(samples);
  std::transform(rates_rad_s.begin(), rates_rad_s.end(), bands.begin(), [&](double w) { return schedule.band(w); });
  std::vector<double> path(samples, 0.0);
  for (std::size_t k = 0; samples > 0 && k < schedule.model(0).size(); ++k) {
    if (const auto steps = scalar_steps(schedule, k, dt_s)) {
      add_scalar(*steps, bands, random, path);
    } else {
      add_switched(schedule, k, bands, dt_s, random, path);
    }
  }
  return path;
}

ImuRun simulate_imu(std::span<const ImuSample> ideal, double dt_s, const ImuModel& model, const ImuHardware& hardware,
                    std::uint64_t seed, std::uint64_t run, const std::stop_token& stop) {
  ImuRun result;
  result.readings.resize(ideal.size());
  std::transform(ideal.begin(), ideal.end(), result.readings.begin(),
                 [&](const ImuSample& sample) { return distorted(sample, hardware); });
  apply_bandwidth(result.readings, hardware, dt_s);
  std::vector<double> rates;
  for (std::size_t c = 0; c < kImuChannels && !stop.stop_requested(); ++c) {
    const AxisModel& axis = model.axes[c];
    Random random(seed, 16 * run + c);
    result.bias[c] = hardware.bias[c] + (axis.bias_sd > 0.0 ? axis.bias_sd * random.normal() : 0.0);
    rates.clear();
    if (c < 3 && axis.processes.size() > 1) {
      rates.resize(ideal.size());
      std::transform(ideal.begin(), ideal.end(), rates.begin(), [c](const ImuSample& sample) { return sample[c]; });
    }
    const std::vector<double> error = simulate_axis(axis.processes, rates, dt_s, ideal.size(), random);
    for (std::size_t t = 0; t < ideal.size(); ++t) {
      result.readings[t][c] = electronics(result.readings[t][c] + result.bias[c] + error[t], hardware.range[c],
                                          hardware.quantization_step[c]);
    }
  }
  return result;
}

}  // namespace driftlab
