#pragma once
/// Quantization noise: differences of a white error of standard deviation Q [unit s] divided by dt (causes.md).
///
/// It is what rounding an angle (velocity) leaves in its differences, and the Q of IEEE Std 952. A sensor that rounds
/// its rate (specific force) to steps s does something else: it adds a white floor of s^2/12 per sample (Widrow 1956),
/// N = s sqrt(dt/12), where the other noise is larger than a step.
///
/// Allan variance 3 Q^2/tau^2, slope -1 of the Allan deviation. Simulated with a uniform error, as a quantizer makes
/// it.
#include "core/process/appearance.hpp"
#include "core/process/haar_differences.hpp"
#include "core/process/parameter.hpp"
#include "core/process/random.hpp"
#include "core/process/state_space.hpp"

#include <array>
#include <cmath>
#include <optional>
#include <span>

namespace driftlab {

struct QuantizationNoise {
  static constexpr std::string_view kName = "quantization_noise";
  static constexpr std::string_view kSymbol = "QN";
  static constexpr std::string_view kTitle = "quantization noise";
  static constexpr bool kRepeats = false;
  static constexpr std::array kParameters{ParameterSpec{.name = "Q", .second_power_halves = 2}};

  double q = 1.0;  ///< standard deviation of the integrated error [unit s]

  /// 6 Q^2/n^2 per sample, n = 2m.
  [[nodiscard]] double haar_variance(double m, double dt_s) const { return 1.5 * error_variance(dt_s) / (m * m); }
  void haar_gradient(double m, double dt_s, std::span<double> out) const { out[0] = 3.0 * q / (dt_s * dt_s * m * m); }
  [[nodiscard]] std::optional<double> spectral_density(double f_hz, double dt_s) const {
    const double s = 2.0 * scaled_phase(f_hz * dt_s, 1.0).sine;
    return dt_s * error_variance(dt_s) * s * s;
  }
  [[nodiscard]] std::optional<double> autocovariance(double lag, double dt_s) const {
    const double distance = std::fabs(lag);
    const double variance = error_variance(dt_s);
    return distance == 0.0 ? 2.0 * variance : (distance == 1.0 ? -variance : 0.0);
  }
  [[nodiscard]] double variogram(double lag, double dt_s) const {
    const double distance = std::fabs(lag);
    const double variance = error_variance(dt_s);
    return distance == 0.0 ? 0.0 : (distance == 1.0 ? 6.0 * variance : 4.0 * variance);
  }
  [[nodiscard]] double haar_cross(double mi, double mj, double h, double dt_s) const {
    if (h > mi + mj) {
      return 0.0;
    }
    return error_variance(dt_s) * haar_cross_of(mi, mj, h, [](double lag) { return lag == 0.0 ? -1.0 : 0.0; });
  }
  [[nodiscard]] Appearance appearance(double /*dt_s*/) const { return {kTitle, std::nullopt, ""}; }
  [[nodiscard]] double haar_mean(double /*m*/, double /*dt_s*/) const { return 0.0; }
  /// Two states: this sample's error and the previous one.
  [[nodiscard]] std::optional<StateSpace> state_space(double dt_s) const {
    StateSpace model;
    model.phi = Eigen::MatrixXd::Zero(2, 2);
    model.phi(1, 0) = 1.0;
    model.q = Eigen::MatrixXd::Zero(2, 2);
    model.q(0, 0) = error_variance(dt_s);
    model.h.resize(2);
    model.h << 1.0, -1.0;
    model.mean0 = Eigen::VectorXd::Zero(2);
    model.cov0 = error_variance(dt_s) * Eigen::MatrixXd::Identity(2, 2);
    return model;
  }
  void add_path(Random& random, double dt_s, std::span<double> out) const {
    const double half_width = std::sqrt(3.0) * q / dt_s;
    double previous = half_width * (2.0 * random.uniform() - 1.0);
    for (double& value : out) {
      const double error = half_width * (2.0 * random.uniform() - 1.0);
      value += error - previous;
      previous = error;
    }
  }
  [[nodiscard]] double differenced_square() const { return q * q; }

  [[nodiscard]] double error_variance(double dt_s) const { return (q / dt_s) * (q / dt_s); }
};

}  // namespace driftlab
