#pragma once
/// White noise behind a moving average: each sample is the mean over `samples` sample intervals. Neighbouring samples
/// are correlated because their means overlap.
///
/// The autocovariance falls on a straight line to zero at a lag of m = `samples`, gamma(h) = g (m - |h|), and the
/// density is the sum of sinc^2((f + k) m) over all aliases k, f in cycles per sample. g is such that the samples have
/// the density N^2 at low frequencies: N is the angle (velocity) random walk, whatever the filter. m need not be whole:
/// a driver that averages 13 readings and gives every fourth has m = 3.25. A width of 1 and less is white noise. With
/// m = k + r between two whole numbers the autocovariance is the mixture (1 - r) t_k + r t_(k+1) of triangles, so all
/// laws are those of whole widths; at a whole width they have a kink in m.
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

struct MovingAverage {
  static constexpr std::string_view kName = "moving_average";
  static constexpr std::string_view kSymbol = "MA";
  static constexpr std::string_view kTitle = "white noise behind a moving average";
  static constexpr bool kRepeats = true;
  static constexpr bool kInOctaveSearch = false;
  /// Wider than this it has no state space: it would have as many states.
  static constexpr double kWidestStates = 16.0;
  static constexpr std::array kParameters{
      ParameterSpec{.name = "N", .second_power_halves = 1},
      ParameterSpec{.name = "samples", .channel_power = 0, .second_power_halves = 0, .lower = 1.0, .upper = 1e9}};

  double n = 1.0;        ///< density at low frequencies [unit sqrt(s)]
  double samples = 1.0;  ///< width m, at least 1

  /// Of a whole width k, times g k^2 = N^2/dt: (2 m k^2 - k^3 + k)/(4 m^2 k^2) from half length m = k on, m/(3 k^2) +
  /// 1/(6 m k^2) up to k/2, a cubic between. m whole.
  [[nodiscard]] double haar_variance(double m, double dt_s) const;
  /// At a whole width the mean of the slopes on both sides.
  void haar_gradient(double m, double dt_s, std::span<double> out) const;
  [[nodiscard]] std::optional<double> spectral_density(double f_hz, double dt_s) const;
  /// Within a tenth up to 0.175/(m dt).
  [[nodiscard]] LowFrequencyDensity low_frequency(double dt_s) const;
  [[nodiscard]] std::optional<double> autocovariance(double lag, double dt_s) const;
  [[nodiscard]] double variogram(double lag, double dt_s) const;
  [[nodiscard]] double haar_cross(double mi, double mj, double h, double dt_s) const;
  [[nodiscard]] Ringing ringing(double /*dt_s*/) const { return {samples + 1.0, 0.25 * samples}; }
  [[nodiscard]] Appearance appearance(double /*dt_s*/) const {
    return {"white noise averaged over ", samples, " samples"};
  }
  [[nodiscard]] double haar_mean(double /*m*/, double /*dt_s*/) const { return 0.0; }
  /// Exact, with as many states as m rounded up: what the noise up to now gives to the present and each later sample.
  /// Nothing where m is above kWidestStates.
  [[nodiscard]] std::optional<StateSpace> state_space(double dt_s) const;
  /// Exact for every width. Two normal numbers per sample, one where m is whole.
  void add_path(Random& random, double dt_s, std::span<double> out) const;
  /// From 1, where the means do not overlap, to a quarter of the record.
  [[nodiscard]] static std::pair<double, double> shape_range(double /*dt_s*/, double samples) {
    return {1.0, std::max(2.0, 0.25 * samples)};
  }
};

}  // namespace driftlab
