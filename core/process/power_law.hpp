#pragma once
/// Power-law noise, density 1/f^alpha with alpha from 0.2 to 1.9: what lies between white noise (0), flicker noise (1)
/// and a random walk (2), and what the long scales of recorded sensors follow.
///
/// It is fractionally differenced white noise (Granger and Joyeux 1980; Hosking 1981) of order alpha/2, with the
/// density
///   S(f) = B^2/(2 pi f_0) |sin(pi f dt)/(pi f_0 dt)|^-alpha,  f_0 = 1 Hz:
/// well below the Nyquist frequency B^2/(2 pi f_0) (f_0/f)^alpha, so that B has the unit of the channel and is that of
/// flicker noise at alpha = 1. Only its increments are stationary from alpha = 1 on. It has no finite state space; the
/// one given is a sum of 16 Gauss-Markov processes, an approximation whose error is stated.
///
/// All laws follow from r(h) = Gamma(h + 1/2 + eta)/Gamma(h + 1/2 - eta), and from its difference to the polynomial in
/// h that it is at alpha = 1, divided by alpha - 1: no law has a pole or loses digits there.
#include "core/process/appearance.hpp"
#include "core/process/parameter.hpp"
#include "core/process/random.hpp"
#include "core/process/state_space.hpp"

#include <array>
#include <optional>
#include <span>
#include <utility>

namespace driftlab {

struct PowerLaw {
  static constexpr std::string_view kName = "power_law";
  static constexpr std::string_view kSymbol = "PL";
  static constexpr std::string_view kTitle = "power-law noise 1/f^alpha";
  static constexpr bool kRepeats = false;
  static constexpr bool kInOctaveSearch = false;
  static constexpr double kLeast = 0.2;
  static constexpr double kMost = 1.9;
  static constexpr std::array kParameters{
      ParameterSpec{.name = "B"},
      ParameterSpec{.name = "alpha", .channel_power = 0, .second_power_halves = 0, .lower = kLeast, .upper = kMost}};

  double b = 1.0;      ///< [unit]; the density at 1 Hz is B^2/(2 pi)
  double alpha = 1.0;  ///< exponent

  /// A [2 E(2m) - 8 E(m) + 6 E(0)] / (4 m^2), with E the difference described above at eta = (alpha + 1)/2 and
  /// A = sin(pi alpha/2) Gamma(2 - alpha)/(pi alpha (1 + alpha)), times the innovations' variance B^2 (2 pi f_0
  /// dt)^(alpha - 1). Grows like m^(alpha - 1).
  [[nodiscard]] double haar_variance(double m, double dt_s) const;
  void haar_gradient(double m, double dt_s, std::span<double> out) const;
  /// Infinite at f = 0.
  [[nodiscard]] std::optional<double> spectral_density(double f_hz, double dt_s) const;
  /// Below alpha = 1.
  [[nodiscard]] std::optional<double> autocovariance(double lag, double dt_s) const;
  [[nodiscard]] double variogram(double lag, double dt_s) const;
  /// Far lags by two terms of the Taylor series, within 1 % of their own small value.
  void add_haar_cross(double mi, double mj, double dt_s, std::span<const double> lags, double factor,
                      std::span<double> out) const;
  [[nodiscard]] Appearance appearance(double /*dt_s*/) const { return {"power-law noise 1/f^", alpha, ""}; }
  [[nodiscard]] double haar_mean(double /*m*/, double /*dt_s*/) const { return 0.0; }
  /// Approximate: up to 16 Gauss-Markov states with correlation times from 0.25 to 8e6 samples, two per decade, fitted
  /// to the density in relative least squares over 10^-7 .. 1/2 cycles a sample. The error is within 0.5 % for every
  /// alpha. Below 10^-7 cycles a sample the density levels off, so the approximation is stationary; its constant part
  /// is not that of the process.
  [[nodiscard]] std::optional<StateSpace> state_space(double dt_s) const;
  /// By circulant embedding of the increments, started at 0: exact second moments of all differences
  /// (stationary_increments.hpp).
  void add_path(Random& random, double dt_s, std::span<double> out) const;
  [[nodiscard]] static std::pair<double, double> shape_range(double /*dt_s*/, double /*samples*/) {
    return {kLeast, kMost};
  }

  /// Variance of the white noise whose fractional sum it is.
  [[nodiscard]] double innovation_variance(double dt_s) const;
};

}  // namespace driftlab
