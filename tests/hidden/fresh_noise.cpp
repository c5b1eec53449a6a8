#include "tests/hidden/fresh_noise.hpp"

#include <Eigen/Dense>

#include <cmath>
#include <numbers>

namespace driftlab::hidden {
namespace {

using investigate::Baseline;
using investigate::ChannelGroup;
using investigate::GivenEffect;
using investigate::StudyRecording;

constexpr double kPi = std::numbers::pi;

void add_gauss_markov(States& states, double variance, double beta, double dt) {
  const double phi = std::exp(-beta * dt);
  states.add_scalar(phi, variance * (1.0 - phi * phi), variance);
}

/// Density B^2/(2 pi f) as Gauss-Markov processes whose rates stand in equal ratios: each adds B^2 ln(ratio)/pi.
void add_flicker(States& states, double b, const StudyRecording& recording) {
  constexpr int kStates = 12;
  const double low = 0.3 / (static_cast<double>(recording.length) * recording.dt_s);
  const double high = kPi / recording.dt_s;
  const double ratio = std::pow(high / low, 1.0 / (kStates - 1));
  for (int k = 0; k < kStates; ++k) {
    add_gauss_markov(states, b * b * std::log(ratio) / kPi, low * std::pow(ratio, k), recording.dt_s);
  }
}

/// (u_i - u_{i-1})/dt with u of standard deviation Q.
void add_differenced(States& states, double q, double dt) {
  Eigen::MatrixXd f = Eigen::MatrixXd::Zero(2, 2);
  f(1, 0) = 1.0;
  Eigen::MatrixXd noise = Eigen::MatrixXd::Zero(2, 2);
  noise(0, 0) = q * q / dt / dt;
  states.add(f, noise, Eigen::MatrixXd::Identity(2, 2) * (q * q / dt / dt), Eigen::RowVector2d(1.0, -1.0));
}

/// White noise of variance `white` behind the bilinear second-order Butterworth low-pass: states s1, s2 of the filter
/// (transposed direct form II) and its next input.
void add_low_pass(States& states, double white, double corner_hz, double dt) {
  const double k = std::tan(kPi * corner_hz * dt);
  const double norm = 1.0 / (1.0 + std::sqrt(2.0) * k + k * k);
  const double b0 = k * k * norm;
  const double b1 = 2.0 * b0;
  const double a1 = 2.0 * (k * k - 1.0) * norm;
  const double a2 = (1.0 - std::sqrt(2.0) * k + k * k) * norm;
  Eigen::MatrixXd f = Eigen::MatrixXd::Zero(3, 3);
  f << -a1, 1.0, b1 - a1 * b0, -a2, 0.0, b0 - a2 * b0, 0.0, 0.0, 0.0;
  Eigen::MatrixXd q = Eigen::MatrixXd::Zero(3, 3);
  q(2, 2) = white;
  Eigen::MatrixXd p = q;
  for (int i = 0; i < 20000; ++i) {
    p = (f * p * f.transpose() + q).eval();
  }
  states.add(f, q, p, Eigen::RowVector3d(1.0, 0.0, b0));
}

}  // namespace

Noise noise_of(const Baseline& model, const StudyRecording& recording, const ChannelGroup& group, double finest) {
  Noise noise;
  noise.white_factor.assign(recording.length, 1.0);
  noise.whole_factor.assign(recording.length, 1.0);
  const double dt = recording.dt_s;
  double white = 0.0;
  const auto own = model.by_channel.find(group.column);
  for (const Process& process : own != model.by_channel.end() ? own->second : model.processes) {
    const std::string name(process.kind->name);
    const auto& p = process.parameters;
    if (name == "white_noise") {
      white += p[0] * p[0] / dt;
    } else if (name == "gauss_markov") {
      add_gauss_markov(noise.states, p[0] * p[0], p[1], dt);
    } else if (name == "random_walk") {
      noise.states.add_scalar(1.0, p[0] * p[0] * dt, 0.0);
    } else if (name == "flicker_noise") {
      add_flicker(noise.states, p[0], recording);
    } else if (name == "quantization_noise") {
      add_differenced(noise.states, p[0], dt);
    }
  }
  for (const GivenEffect& effect : model.effects) {
    if (!lists(effect.channels, group.column) || !lists(effect.recordings, recording.id)) {
      continue;
    }
    const double p = effect.values[0];
    const double second = effect.values.size() > 1 ? effect.values[1] : 0.0;
    const std::size_t axis = group.role.quantity == Quantity::AngularRate ? group.axis() : 2;
    if (effect.cause == "white_noise_level") {
      white = p * p / dt;
    } else if (effect.cause == "gauss_markov") {
      add_gauss_markov(noise.states, p * p, second, dt);
    } else if (effect.cause == "random_walk") {
      noise.states.add_scalar(1.0, p * p * dt, 0.0);
    } else if (effect.cause == "flicker_noise") {
      add_flicker(noise.states, p, recording);
    } else if (effect.cause == "quantization_noise") {
      add_differenced(noise.states, p, dt);
    } else if (effect.cause == "turn_on_bias") {
      noise.states.add_scalar(1.0, 0.0, p * p);
    } else if (effect.cause == "rate_dependent_noise" || effect.cause == "acceleration_dependent_noise") {
      const auto& driver = effect.cause == "rate_dependent_noise" ? recording.rate[axis] : recording.acceleration[axis];
      for (std::size_t i = 0; i < recording.length; ++i) {
        noise.white_factor[i] *= 1.0 + p * std::fabs(at(driver, i));
      }
    } else if (effect.cause == "noise_level_change") {
      for (std::size_t i = 0; i < recording.length; ++i) {
        noise.whole_factor[i] *= recording.time_s(i) >= second ? p : 1.0;
      }
    } else if (effect.cause == "heavy_tailed_noise") {
      noise.nu = p;
    } else if (effect.cause == "outliers") {
      noise.fraction = p;
      noise.magnitude = second;
    } else if (effect.cause == "output_resolution") {
      noise.step = p;
    } else if (effect.cause == "common_mode_noise") {
      noise.correlation = p;
    } else if (effect.cause == "band_limited_noise") {
      add_low_pass(noise.states, white, p, dt);
      white = 0.0;
    }
  }
  noise.states.white = white + finest * finest / 12.0;
  return noise;
}

}  // namespace driftlab::hidden
