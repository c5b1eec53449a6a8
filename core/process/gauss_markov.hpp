#pragma once
/// First-order Gauss-Markov process: a bias that varies randomly and reverts to its mean at the rate beta.
///
/// It consists of point samples of dX = -beta X dt + sqrt(2 beta) sigma dW, an AR(1) process with phi = exp(-beta dt)
/// and stationary variance sigma^2. As beta -> 0 with 2 beta sigma^2 fixed it becomes a random walk; as beta ->
/// infinity, white noise. The closed forms below keep 15 digits for x = beta dt from 1e-14 to 700 and scales up to
/// 2^30, where the usual form loses all of them.
#include "core/process/appearance.hpp"
#include "core/process/low_frequency.hpp"
#include "core/process/parameter.hpp"
#include "core/process/random.hpp"
#include "core/process/slow_law.hpp"
#include "core/process/state_space.hpp"

#include <array>
#include <optional>
#include <span>
#include <utility>

namespace driftlab {

struct GaussMarkov {
  static constexpr std::string_view kName = "gauss_markov";
  static constexpr std::string_view kSymbol = "GM";
  static constexpr std::string_view kTitle = "first-order Gauss-Markov process";
  static constexpr bool kRepeats = true;
  static constexpr std::array kParameters{ParameterSpec{.name = "sigma"},
                                          ParameterSpec{.name = "beta", .channel_power = 0, .second_power_halves = -2}};

  double sigma = 1.0;  ///< stationary standard deviation [unit]
  double beta = 1.0;   ///< inverse correlation time [1/s]

  /// sigma^2 [2m (sinh x - x) + p(mx)] / (8 m^2 sinh^2(x/2)), p(y) = 2y - 3 + 4 e^-y - e^-2y: a sum of positive terms.
  [[nodiscard]] double haar_variance(double m, double dt_s) const;
  void haar_gradient(double m, double dt_s, std::span<double> out) const;
  void haar_curve(std::span<const double> half, double dt_s, std::span<double> variance,
                  std::span<double> gradient) const;
  /// dt sigma^2 (1 - phi^2) / (1 - 2 phi cos(2 pi f dt) + phi^2).
  [[nodiscard]] std::optional<double> spectral_density(double f_hz, double dt_s) const;
  /// dt sigma^2 coth(x/2), about 2 sigma^2/beta, within a tenth up to a third of the corner beta/(2 pi).
  [[nodiscard]] LowFrequencyDensity low_frequency(double dt_s) const;
  [[nodiscard]] std::optional<double> autocovariance(double lag, double dt_s) const;
  [[nodiscard]] double variogram(double lag, double dt_s) const;
  [[nodiscard]] double haar_cross(double mi, double mj, double h, double dt_s) const;
  /// haar_cross over many lags with one exponential per lag.
  void add_haar_cross(double mi, double mj, double dt_s, std::span<const double> lags, double factor,
                      std::span<double> out) const;
  /// One that is faster than some five samples is the bandwidth of the sensor; slower ones are the usual bias.
  [[nodiscard]] std::optional<Appearance> appearance(double dt_s) const {
    return beta * dt_s < 0.2 ? std::nullopt
                             : std::optional(Appearance{"a process of ", 1e3 / beta, " ms correlation time"});
  }
  [[nodiscard]] double haar_mean(double /*m*/, double /*dt_s*/) const { return 0.0; }
  [[nodiscard]] std::optional<StateSpace> state_space(double dt_s) const;
  /// Starts in the stationary distribution.
  void add_path(Random& random, double dt_s, std::span<double> out) const;
  /// Means over L samples with phi = exp(-beta dt) have autocovariance
  ///   lag 0: s^2/L^2 [L + 2 sum_{k=1}^{L-1} (L-k) phi^k],  lag j >= 1: A phi^{L j},
  ///   A = s^2 phi^{1-L} [(1-phi^L)/(L(1-phi))]^2:
  /// a first-order autoregression of variance A and a white remainder, lag 0 minus A, not positive.
  static void add_block_states(double square, double beta, const Blocks& blocks, BlockStates& states);
  /// s^2 dt (2 Re[1/(1-z) - z (1-phi^n)/(n (1-z)^2)] - 1), z = phi exp(-i w).
  [[nodiscard]] static double expected_periodogram(double square, double beta, double f_hz, double dt_s,
                                                   double samples);
  /// Correlation times from 1/8 of a sample to a thousand times the length of the record. Beyond either end the process
  /// equals white noise or a random walk to nine digits.
  [[nodiscard]] static std::pair<double, double> shape_range(double dt_s, double samples) {
    return {1e-3 / (samples * dt_s), 8.0 / dt_s};
  }
};

}  // namespace driftlab
