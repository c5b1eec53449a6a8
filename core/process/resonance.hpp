#pragma once
/// Resonance: a second-order Gauss-Markov process, white noise that drives a damped oscillation.
///
/// It consists of point samples of x'' + (w/Q) x' + w^2 x = white noise with w = 2 pi f: stationary standard deviation
/// sigma, natural frequency f, quality Q (Maybeck 1979, sec. 4.11, "second-order Markov process", damping ratio
/// 1/(2 Q)). For Q well above 1 the spectrum has a peak at f of width f/Q; correlations die out after Q/(pi f). Above
/// the Nyquist frequency the peak shows where it is folded to. With Q = 0.707 it is white noise behind a second-order
/// low-pass (low_pass_2.hpp); with Q of 1/2 and less nothing oscillates, and a sum of Gauss-Markov processes says it.
#include "core/process/appearance.hpp"
#include "core/process/low_frequency.hpp"
#include "core/process/parameter.hpp"
#include "core/process/random.hpp"
#include "core/process/ringing.hpp"
#include "core/process/state_space.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <utility>

namespace driftlab {

struct Resonance {
  static constexpr std::string_view kName = "resonance";
  static constexpr std::string_view kSymbol = "RES";
  static constexpr std::string_view kTitle = "resonance (second-order Gauss-Markov process)";
  static constexpr bool kRepeats = true;
  static constexpr bool kInOctaveSearch = false;
  static constexpr double kLeastQuality = 0.51;
  static constexpr std::array kParameters{
      ParameterSpec{.name = "sigma"},
      ParameterSpec{.name = "frequency_hz", .channel_power = 0, .second_power_halves = -2},
      ParameterSpec{.name = "quality", .channel_power = 0, .second_power_halves = 0, .lower = kLeastQuality}};

  double sigma = 1.0;         ///< stationary standard deviation [unit]
  double frequency_hz = 1.0;  ///< natural frequency; the density peaks at f sqrt(1 - 1/(2 Q^2))
  double quality = 1.0;       ///< centre frequency over half-power width

  /// Closed form (damped_oscillation.hpp).
  [[nodiscard]] double haar_variance(double m, double dt_s) const;
  void haar_gradient(double m, double dt_s, std::span<double> out) const;
  void haar_curve(std::span<const double> half, double dt_s, std::span<double> variance,
                  std::span<double> gradient) const;
  /// Of the samples: the sum over all aliases of (4 zeta sigma^2/w) / [(1 - u^2)^2 + (u/Q)^2], u the frequency over f.
  [[nodiscard]] std::optional<double> spectral_density(double f_hz, double dt_s) const;
  /// About 2 sigma^2/(Q w), within a tenth up to some 0.3 f where the quality is above 1.
  [[nodiscard]] LowFrequencyDensity low_frequency(double dt_s) const;
  [[nodiscard]] std::optional<double> autocovariance(double lag, double dt_s) const;
  [[nodiscard]] double variogram(double lag, double dt_s) const;
  void add_haar_cross(double mi, double mj, double dt_s, std::span<const double> lags, double factor,
                      std::span<double> out) const;
  [[nodiscard]] Ringing ringing(double dt_s) const;
  [[nodiscard]] Appearance appearance(double /*dt_s*/) const { return {"a resonance at ", frequency_hz, " Hz"}; }
  [[nodiscard]] double haar_mean(double /*m*/, double /*dt_s*/) const { return 0.0; }
  /// Two states, exact.
  [[nodiscard]] std::optional<StateSpace> state_space(double dt_s) const;
  /// Starts in the stationary distribution. Two normal numbers per sample.
  void add_path(Random& random, double dt_s, std::span<double> out) const;
  /// One period per record up to the Nyquist frequency; a quality at which the oscillation at a quarter of the sampling
  /// rate loses its phase within the record.
  [[nodiscard]] static std::array<std::pair<double, double>, 2> shape_ranges(double dt_s, double samples) {
    return {std::pair{1.0 / (samples * dt_s), 0.5 / dt_s}, std::pair{kLeastQuality, std::max(1.0, samples)}};
  }
};

}  // namespace driftlab
