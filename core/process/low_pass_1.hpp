#pragma once
/// White noise behind a first-order low-pass of corner f_c, sampled.
///
/// Its density is N^2/(1 + (f/f_c)^2) and all its aliases, scaled to the density N^2 that the samples have at low
/// frequencies: N is the angle (velocity) random walk, whatever the filter. It is a first-order Gauss-Markov process in
/// other words, beta = 2 pi f_c and sigma^2 = N^2 tanh(beta dt/2)/dt, and no curve tells the two apart: a model needs
/// one of them for each fast process. This one has the parameters of a data sheet. A corner above the sampling rate
/// leaves white noise.
#include "core/process/appearance.hpp"
#include "core/process/gauss_markov.hpp"
#include "core/process/low_frequency.hpp"
#include "core/process/parameter.hpp"
#include "core/process/random.hpp"
#include "core/process/state_space.hpp"
#include "core/signal/turns.hpp"

#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <utility>

namespace driftlab {

struct LowPass1 {
  static constexpr std::string_view kName = "low_pass_1";
  static constexpr std::string_view kSymbol = "LP1";
  static constexpr std::string_view kTitle = "white noise behind a first-order low-pass";
  static constexpr bool kRepeats = true;
  static constexpr bool kInOctaveSearch = false;
  static constexpr std::array kParameters{
      ParameterSpec{.name = "N", .second_power_halves = 1},
      ParameterSpec{.name = "corner_hz", .channel_power = 0, .second_power_halves = -2}};

  double n = 1.0;          ///< density at low frequencies [unit sqrt(s)]
  double corner_hz = 1.0;  ///< half power

  [[nodiscard]] double haar_variance(double m, double dt_s) const { return same(dt_s).haar_variance(m, dt_s); }
  void haar_gradient(double m, double dt_s, std::span<double> out) const {
    const GaussMarkov process = same(dt_s);
    process.haar_gradient(m, dt_s, out);
    // sigma^2 is proportional to tanh(x/2), x = 2 pi f_c dt, whose logarithm has the derivative 1/sinh x.
    const double x = process.beta * dt_s;
    const double variance = process.haar_variance(m, dt_s);
    const double by_level = x < 700.0 ? variance * x / (std::sinh(x) * corner_hz) : 0.0;
    out[0] = 2.0 * variance / n;
    out[1] = out[1] * kTurn + by_level;
  }
  [[nodiscard]] std::optional<double> spectral_density(double f_hz, double dt_s) const {
    return same(dt_s).spectral_density(f_hz, dt_s);
  }
  [[nodiscard]] LowFrequencyDensity low_frequency(double /*dt_s*/) const { return {n * n, corner_hz / 3.0}; }
  [[nodiscard]] std::optional<double> autocovariance(double lag, double dt_s) const {
    return same(dt_s).autocovariance(lag, dt_s);
  }
  [[nodiscard]] double variogram(double lag, double dt_s) const { return same(dt_s).variogram(lag, dt_s); }
  void add_haar_cross(double mi, double mj, double dt_s, std::span<const double> lags, double factor,
                      std::span<double> out) const {
    same(dt_s).add_haar_cross(mi, mj, dt_s, lags, factor, out);
  }
  [[nodiscard]] Appearance appearance(double /*dt_s*/) const { return {"a low-pass at ", corner_hz, " Hz"}; }
  [[nodiscard]] double haar_mean(double /*m*/, double /*dt_s*/) const { return 0.0; }
  /// One state, exact.
  [[nodiscard]] std::optional<StateSpace> state_space(double dt_s) const { return same(dt_s).state_space(dt_s); }
  void add_path(Random& random, double dt_s, std::span<double> out) const { same(dt_s).add_path(random, dt_s, out); }
  /// Corners from one hundredth of the Nyquist frequency, below which the process is a Gauss-Markov bias, to 2.6 times
  /// it, above which it is white noise.
  [[nodiscard]] static std::pair<double, double> shape_range(double dt_s, double /*samples*/) {
    return {0.005 / dt_s, 1.3 / dt_s};
  }

  /// The first-order Gauss-Markov process with the same law.
  [[nodiscard]] GaussMarkov same(double dt_s) const {
    const double beta = kTurn * corner_hz;
    return {n * std::sqrt(std::tanh(0.5 * beta * dt_s) / dt_s), beta};
  }
};

}  // namespace driftlab
