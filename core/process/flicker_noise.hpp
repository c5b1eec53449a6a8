#pragma once
/// Flicker noise (bias instability): two-sided density B^2/(2 pi |f|) up to the Nyquist frequency, without aliasing.
///
/// The floor of its Allan deviation is sqrt(2 ln 2/pi) B = 0.664 B. Only its increments are stationary. It has no
/// finite state space; the one given is a sum of 16 Gauss-Markov processes, an approximation whose error is stated.
#include "core/process/appearance.hpp"
#include "core/process/parameter.hpp"
#include "core/process/random.hpp"
#include "core/process/slow_law.hpp"
#include "core/process/state_space.hpp"

#include <array>
#include <optional>
#include <span>

namespace driftlab {

struct FlickerNoise {
  static constexpr std::string_view kName = "flicker_noise";
  static constexpr std::string_view kSymbol = "FN";
  static constexpr std::string_view kTitle = "flicker noise (bias instability)";
  static constexpr bool kRepeats = false;
  static constexpr std::array kParameters{ParameterSpec{.name = "B"}};

  double b = 1.0;  ///< [unit]

  /// (B^2/pi) int_0^{pi/2} sin^4(mu) / (m^2 u sin^2 u) du, by parts: leading term Cin(2 pi m) - Cin(pi m) -> ln 2.
  /// Relative accuracy 1e-13. m whole.
  [[nodiscard]] double haar_variance(double m, double dt_s) const;
  void haar_gradient(double m, double dt_s, std::span<double> out) const;
  /// Infinite at f = 0.
  [[nodiscard]] std::optional<double> spectral_density(double f_hz, double dt_s) const;
  [[nodiscard]] std::optional<double> autocovariance(double /*lag*/, double /*dt_s*/) const { return std::nullopt; }
  /// (2 B^2/pi) Cin(pi h), Cin(x) = int_0^x (1 - cos t)/t dt; h whole.
  [[nodiscard]] double variogram(double lag, double dt_s) const;
  [[nodiscard]] double haar_cross(double mi, double mj, double h, double dt_s) const;
  [[nodiscard]] Appearance appearance(double /*dt_s*/) const { return {kTitle, std::nullopt, ""}; }
  [[nodiscard]] double haar_mean(double /*m*/, double /*dt_s*/) const { return 0.0; }
  /// Approximate. It has 16 Gauss-Markov states with stationary variances between 0.1 and 0.9 B^2 and correlation times
  /// from 0.4 to 1.3e7 samples, two per decade, fitted to the density in relative least squares over 10^-7 .. 1/2
  /// cycles a sample. The error is within 1.6 % below 1/20 of the sampling rate, and 17 % at the Nyquist frequency,
  /// where the spectrum of an autoregression must be flat. Below 10^-7 cycles a sample the density levels off, so the
  /// approximation is stationary; its constant part is not that of the process.
  [[nodiscard]] std::optional<StateSpace> state_space(double dt_s) const;
  /// Circulant embedding of the stationary increments (stationary_increments.hpp), started at 0: exact second moments
  /// of all differences.
  void add_path(Random& random, double dt_s, std::span<double> out) const;
  /// Approximate: six Gauss-Markov processes with correlation times spaced evenly in the logarithm, from two samples to
  /// twice the longest record; the integral of their densities over ln(tau) is 1/f. Variances of differences of single
  /// samples come out 36 % too large, of longer blocks less. Those that decay within half a block keep their variance
  /// and their covariance of neighbouring blocks, and take nothing from the white noise beside them.
  static void add_block_states(double square, double shape, const Blocks& blocks, BlockStates& states);
  /// The density.
  [[nodiscard]] static double expected_periodogram(double square, double shape, double f_hz, double dt_s,
                                                   double samples);
};

}  // namespace driftlab
