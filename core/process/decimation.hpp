#pragma once
/// White noise behind the third-order sinc decimator of an oversampling converter: averaged three times over `samples`
/// sample intervals each (a cascade of integrators and combs; Hogenauer 1981), then sampled.
///
/// The autocovariance at lag h is g B(h/m), m = `samples`, with B the quintic B-spline, which ends at a lag of 3 m; the
/// density is the sum of sinc^6((f + k) m) over all aliases k, f in cycles per sample. g is such that the samples have
/// the density N^2 at low frequencies: N is the angle (velocity) random walk, whatever the filter. m = 1 is the usual
/// decimator, whose three averages are each one output interval long. Where only every k-th of its outputs is recorded,
/// m is 1/k; samples with m of 1/3 and less are white noise.
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

struct Decimation {
  static constexpr std::string_view kName = "decimation";
  static constexpr std::string_view kSymbol = "DEC";
  static constexpr std::string_view kTitle = "white noise behind a third-order sinc decimator";
  static constexpr bool kRepeats = true;
  static constexpr bool kInOctaveSearch = false;
  static constexpr double kWidest = 64.0;
  /// More states than this, ceil(3 m), and there is no state space.
  static constexpr int kMostStates = 16;
  static constexpr std::array kParameters{
      ParameterSpec{.name = "N", .second_power_halves = 1},
      ParameterSpec{
          .name = "samples", .channel_power = 0, .second_power_halves = 0, .lower = 1.0 / 3.0, .upper = kWidest}};

  double n = 1.0;        ///< density at low frequencies [unit sqrt(s)]
  double samples = 1.0;  ///< width m of each average

  /// Sum of the autocovariances times the Haar filter's, 6 m terms.
  [[nodiscard]] double haar_variance(double m, double dt_s) const;
  void haar_gradient(double m, double dt_s, std::span<double> out) const;
  /// Both for many m: the autocovariances are computed once, and where m is 3 `samples` and more, the filter's own is a
  /// straight line over all of them.
  void haar_curve(std::span<const double> half, double dt_s, std::span<double> variance,
                  std::span<double> gradient) const;
  [[nodiscard]] std::optional<double> spectral_density(double f_hz, double dt_s) const;
  /// Within a tenth up to 0.103/(m dt).
  [[nodiscard]] LowFrequencyDensity low_frequency(double dt_s) const;
  [[nodiscard]] std::optional<double> autocovariance(double lag, double dt_s) const;
  [[nodiscard]] double variogram(double lag, double dt_s) const;
  void add_haar_cross(double mi, double mj, double dt_s, std::span<const double> lags, double factor,
                      std::span<double> out) const;
  [[nodiscard]] Ringing ringing(double /*dt_s*/) const { return {3.0 * samples + 1.0, 0.5 * samples}; }
  [[nodiscard]] Appearance appearance(double /*dt_s*/) const {
    return {"white noise averaged three times over ", samples, " samples"};
  }
  [[nodiscard]] double haar_mean(double /*m*/, double /*dt_s*/) const { return 0.0; }
  /// Exact, with ceil(3 m) states: what the noise up to now gives to the present and each later sample.
  [[nodiscard]] std::optional<StateSpace> state_space(double dt_s) const;
  /// Exact, from at most twelve normal numbers per sample.
  void add_path(Random& random, double dt_s, std::span<double> out) const;
  /// From hardly any correlation of neighbours up to a third of the shortest record, at most kWidest.
  [[nodiscard]] static std::pair<double, double> shape_range(double dt_s, double samples);
};

}  // namespace driftlab
