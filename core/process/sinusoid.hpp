#pragma once
/// Sinusoid: amplitude * sin(2 pi f t + phase) with a phase uniform over the circle.
///
/// Its spectrum is a line, so it has no density; its wavelet variance has zeros wherever f m is whole.
#include "core/process/appearance.hpp"
#include "core/process/haar_differences.hpp"
#include "core/process/parameter.hpp"
#include "core/process/random.hpp"
#include "core/process/state_space.hpp"
#include "core/signal/turns.hpp"

#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <span>
#include <utility>

namespace driftlab {

struct Sinusoid {
  static constexpr std::string_view kName = "sinusoid";
  static constexpr std::string_view kSymbol = "SIN";
  static constexpr std::string_view kTitle = "sinusoid of random phase";
  static constexpr bool kRepeats = true;
  static constexpr std::array kParameters{
      ParameterSpec{.name = "amplitude"},
      ParameterSpec{.name = "frequency_hz", .channel_power = 0, .second_power_halves = -2}};

  double amplitude = 1.0;
  double frequency_hz = 1.0;

  /// A^2/2 sin^4(pi f m)/(m^2 sin^2(pi f)), f in cycles per sample.
  [[nodiscard]] double haar_variance(double m, double dt_s) const {
    const double wide = scaled_phase(frequency_hz * dt_s, m).sine;
    const double narrow = scaled_phase(frequency_hz * dt_s, 1.0).sine;
    const double ratio = wide / (m * narrow);  // tends to 1 as f -> 0
    return 0.5 * amplitude * amplitude * wide * wide * ratio * ratio;
  }
  void haar_gradient(double m, double dt_s, std::span<double> out) const {
    const ScaledPhase wide = scaled_phase(frequency_hz * dt_s, m);
    const ScaledPhase narrow = scaled_phase(frequency_hz * dt_s, 1.0);
    const double ratio = wide.sine / (m * narrow.sine);
    out[0] = amplitude * wide.sine * wide.sine * ratio * ratio;
    const double slope = 4.0 * m * wide.cosine - 2.0 * wide.sine * narrow.cosine / narrow.sine;
    out[1] = 0.5 * amplitude * amplitude * std::numbers::pi * dt_s * wide.sine * ratio * ratio * slope;
  }
  void haar_curve(std::span<const double> half, double dt_s, std::span<double> variance,
                  std::span<double> gradient) const {
    const ScaledPhase narrow = scaled_phase(frequency_hz * dt_s, 1.0);
    for (std::size_t j = 0; j < half.size(); ++j) {
      const ScaledPhase wide = scaled_phase(frequency_hz * dt_s, half[j]);
      const double ratio = wide.sine / (half[j] * narrow.sine);
      const double unit = wide.sine * wide.sine * ratio * ratio;
      variance[j] = 0.5 * amplitude * amplitude * unit;
      if (!gradient.empty()) {
        const double slope = 4.0 * half[j] * wide.cosine - 2.0 * wide.sine * narrow.cosine / narrow.sine;
        gradient[2 * j] = amplitude * unit;
        gradient[2 * j + 1] = 0.5 * amplitude * amplitude * std::numbers::pi * dt_s * wide.sine * ratio * ratio * slope;
      }
    }
  }
  [[nodiscard]] std::optional<double> spectral_density(double /*f_hz*/, double /*dt_s*/) const { return std::nullopt; }
  [[nodiscard]] std::optional<double> autocovariance(double lag, double dt_s) const {
    return 0.5 * amplitude * amplitude * scaled_phase(2.0 * frequency_hz * dt_s, lag).cosine;
  }
  [[nodiscard]] double variogram(double lag, double dt_s) const {
    const double s = scaled_phase(frequency_hz * dt_s, lag).sine;
    return 2.0 * amplitude * amplitude * s * s;
  }
  /// Given its phase a sinusoid is deterministic; its squares average out over a record, so it adds no scatter.
  [[nodiscard]] double haar_cross(double /*mi*/, double /*mj*/, double /*h*/, double /*dt_s*/) const { return 0.0; }
  [[nodiscard]] Appearance appearance(double /*dt_s*/) const { return {"a line at ", frequency_hz, " Hz"}; }
  [[nodiscard]] double haar_mean(double /*m*/, double /*dt_s*/) const { return 0.0; }
  /// A rotating pair of states.
  [[nodiscard]] std::optional<StateSpace> state_space(double dt_s) const {
    const ScaledPhase turn = scaled_phase(2.0 * frequency_hz * dt_s, 1.0);
    StateSpace model;
    model.phi.resize(2, 2);
    model.phi << turn.cosine, turn.sine, -turn.sine, turn.cosine;
    model.q = Eigen::MatrixXd::Zero(2, 2);
    model.h = Eigen::RowVectorXd::Unit(2, 0);
    model.mean0 = Eigen::VectorXd::Zero(2);
    model.cov0 = 0.5 * amplitude * amplitude * Eigen::MatrixXd::Identity(2, 2);
    return model;
  }
  void add_path(Random& random, double dt_s, std::span<double> out) const {
    const double phase = kTurn * random.uniform();
    for (std::size_t t = 0; t < out.size(); ++t) {
      const ScaledPhase turn = scaled_phase(2.0 * frequency_hz * dt_s, static_cast<double>(t));
      out[t] += amplitude * (turn.sine * std::cos(phase) + turn.cosine * std::sin(phase));
    }
  }
  /// One period per record up to the Nyquist frequency.
  [[nodiscard]] static std::pair<double, double> shape_range(double dt_s, double samples) {
    return {1.0 / (samples * dt_s), 0.5 / dt_s};
  }
};

}  // namespace driftlab
