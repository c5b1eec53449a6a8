#pragma once
/// White noise behind a second-order Butterworth low-pass of corner f_c, sampled.
///
/// Its density is N^2/(1 + (f/f_c)^4) and all its aliases, scaled to the density N^2 that the samples have at low
/// frequencies: N is the angle (velocity) random walk, whatever the filter. It is a second-order Gauss-Markov process
/// of quality 1/sqrt(2) (resonance.hpp). An investigation's finding `band_limited_noise` is the same filter made of
/// samples (bilinear transform), which has a zero at the Nyquist frequency where this one has its aliases; below a
/// quarter of the sampling rate their shapes agree to some per cent.
#include "core/process/appearance.hpp"
#include "core/process/low_frequency.hpp"
#include "core/process/parameter.hpp"
#include "core/process/random.hpp"
#include "core/process/ringing.hpp"
#include "core/process/state_space.hpp"

#include <array>
#include <optional>
#include <span>
#include <utility>

namespace driftlab {

struct LowPass2 {
  static constexpr std::string_view kName = "low_pass_2";
  static constexpr std::string_view kSymbol = "LP2";
  static constexpr std::string_view kTitle = "white noise behind a second-order low-pass";
  static constexpr bool kRepeats = true;
  static constexpr bool kInOctaveSearch = false;
  static constexpr std::array kParameters{
      ParameterSpec{.name = "N", .second_power_halves = 1},
      ParameterSpec{.name = "corner_hz", .channel_power = 0, .second_power_halves = -2}};

  double n = 1.0;          ///< density at low frequencies [unit sqrt(s)]
  double corner_hz = 1.0;  ///< half power

  /// Closed form (damped_oscillation.hpp).
  [[nodiscard]] double haar_variance(double m, double dt_s) const;
  void haar_gradient(double m, double dt_s, std::span<double> out) const;
  [[nodiscard]] std::optional<double> spectral_density(double f_hz, double dt_s) const;
  [[nodiscard]] LowFrequencyDensity low_frequency(double dt_s) const;
  [[nodiscard]] std::optional<double> autocovariance(double lag, double dt_s) const;
  [[nodiscard]] double variogram(double lag, double dt_s) const;
  void add_haar_cross(double mi, double mj, double dt_s, std::span<const double> lags, double factor,
                      std::span<double> out) const;
  [[nodiscard]] Ringing ringing(double dt_s) const;
  [[nodiscard]] Appearance appearance(double /*dt_s*/) const { return {"a low-pass at ", corner_hz, " Hz"}; }
  [[nodiscard]] double haar_mean(double /*m*/, double /*dt_s*/) const { return 0.0; }
  /// Two states, exact.
  [[nodiscard]] std::optional<StateSpace> state_space(double dt_s) const;
  void add_path(Random& random, double dt_s, std::span<double> out) const;
  /// As of low_pass_1.hpp.
  [[nodiscard]] static std::pair<double, double> shape_range(double dt_s, double /*samples*/) {
    return {0.005 / dt_s, 1.3 / dt_s};
  }

  /// Variance of a sample.
  [[nodiscard]] double sample_variance(double dt_s) const;
};

}  // namespace driftlab
