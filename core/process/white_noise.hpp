#pragma once
/// White noise: angle (velocity) random walk of a gyro (accelerometer).
///
/// Independent samples of variance N^2/dt; two-sided density N^2 [unit^2 s]; Allan deviation N/sqrt(tau).
/// Rounding a rate to steps s adds white noise of variance s^2/12; see quantization_noise.hpp.
#include "core/process/haar_differences.hpp"
#include "core/process/low_frequency.hpp"
#include "core/process/parameter.hpp"
#include "core/process/random.hpp"
#include "core/process/state_space.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <span>

namespace driftlab {

struct WhiteNoise {
  static constexpr std::string_view kName = "white_noise";
  static constexpr std::string_view kSymbol = "WN";
  static constexpr std::string_view kTitle = "white noise (angle or velocity random walk)";
  static constexpr bool kRepeats = false;
  static constexpr std::array kParameters{ParameterSpec{.name = "N", .second_power_halves = 1}};

  double n = 1.0;  ///< density [unit sqrt(s)]

  /// s2/n with n = 2m (Percival and Walden 2000).
  [[nodiscard]] double haar_variance(double m, double dt_s) const { return sample_variance(dt_s) / (2.0 * m); }
  void haar_gradient(double m, double dt_s, std::span<double> out) const { out[0] = n / (m * dt_s); }
  [[nodiscard]] std::optional<double> spectral_density(double /*f_hz*/, double /*dt_s*/) const { return n * n; }
  [[nodiscard]] std::optional<double> autocovariance(double lag, double dt_s) const {
    return lag == 0.0 ? sample_variance(dt_s) : 0.0;
  }
  [[nodiscard]] double variogram(double lag, double dt_s) const {
    return lag == 0.0 ? 0.0 : 2.0 * sample_variance(dt_s);
  }
  [[nodiscard]] double haar_cross(double mi, double mj, double h, double dt_s) const {
    if (h >= mi + mj) {
      return 0.0;
    }
    return sample_variance(dt_s) * haar_cross_of(mi, mj, h, [](double lag) { return 0.5 * std::fabs(lag); });
  }
  [[nodiscard]] double haar_mean(double /*m*/, double /*dt_s*/) const { return 0.0; }
  [[nodiscard]] std::optional<StateSpace> state_space(double dt_s) const {
    StateSpace model;
    model.phi.resize(0, 0);
    model.q.resize(0, 0);
    model.h.resize(0);
    model.mean0.resize(0);
    model.cov0.resize(0, 0);
    model.r = sample_variance(dt_s);
    return model;
  }
  void add_path(Random& random, double dt_s, std::span<double> out) const {
    const double sd = n / std::sqrt(dt_s);
    for (double& value : out) {
      value += sd * random.normal();
    }
  }
  [[nodiscard]] LowFrequencyDensity low_frequency(double /*dt_s*/) const {
    return {n * n, std::numeric_limits<double>::infinity()};
  }
  [[nodiscard]] double white_square() const { return n * n; }

  [[nodiscard]] double sample_variance(double dt_s) const { return n * n / dt_s; }
};

}  // namespace driftlab
