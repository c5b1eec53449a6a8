#pragma once
/// The second-order Gauss-Markov process of unit variance, in samples: the laws behind resonance.hpp and
/// low_pass_2.hpp.
///
/// Point samples of x'' + (w/Q) x' + w^2 x = white noise have the autocovariance
///   gamma(h) = e^-a|h| [cos bh + (a/b) sin b|h|],  a = w/(2 Q),  b = w sqrt(1 - 1/(4 Q^2)),
/// which is Re[C e^-x|h|] with x = a + ib and C = 1 + ia/b: the laws of a first-order process (gauss_markov.hpp) with a
/// complex rate. They keep nine digits for a quality from 0.51 to 10^4, and seven where w m is as small as 10^-7.
#include "core/process/random.hpp"
#include "core/process/ringing.hpp"
#include "core/process/state_space.hpp"

#include <complex>
#include <cstddef>
#include <span>

namespace driftlab {

class DampedOscillation {
 public:
  /// `rate` is w in radians per sample, at any multiple of pi (samples fold it); `quality` is Q > 1/2.
  DampedOscillation(double rate, double quality);

  /// Derivatives by rate and quality.
  struct Slope {
    double by_rate = 0.0;
    double by_quality = 0.0;
  };

  /// Re[C F(x)], F(x) = [2m (sinh x - x) + p(mx)] / (8 m^2 sinh^2(x/2)), p(y) = 2y - 3 + 4 e^-y - e^-2y.
  [[nodiscard]] double haar_variance(double m) const;
  [[nodiscard]] Slope haar_slope(double m) const;
  /// Both for many m: `take(j, variance, slope)` at each. What they share is computed once.
  template <class Take>
  void each_haar(std::span<const double> half, Take&& take) const {
    const Shared shared = this->shared();
    for (std::size_t j = 0; j < half.size(); ++j) {
      Slope slope;
      const double variance = haar_at(shared, half[j], slope);
      take(j, variance, slope);
    }
  }
  /// sum_h gamma(h) e^(-2 pi i f h), f in cycles per sample: its integral over (-1/2, 1/2) is 1. Aliases are in it.
  [[nodiscard]] double density(double f) const;
  /// The same at f = 0, Re[C coth(x/2)], and its derivatives.
  [[nodiscard]] double density_at_zero() const;
  [[nodiscard]] Slope density_slope_at_zero() const;
  [[nodiscard]] double autocovariance(double lag) const;
  /// 2 [gamma(0) - gamma(h)].
  [[nodiscard]] double variogram(double lag) const;
  /// Adds `factor` times the covariance of Haar coefficients, one value per lag.
  void add_haar_cross(double mi, double mj, std::span<const double> lags, double factor, std::span<double> out) const;
  /// Down to 5e-5 of the peak, at most 256 lengths; a length is 2.5/w, four fifths of a period of gamma^2.
  [[nodiscard]] Ringing ringing() const;
  /// Position and velocity/w as the two states: exact, stationary from the start, variance `square`.
  [[nodiscard]] StateSpace state_space(double square) const;
  /// Adds a path of standard deviation `sigma`, stationary from the start; two normal numbers per sample.
  void add_path(double sigma, Random& random, std::span<double> out) const;

 private:
  [[nodiscard]] std::complex<double> haar_cross(double mi, double mj, double h) const;
  /// Of all Haar variances: sinh x - x, 1/(8 sinh^2(x/2)), coth(x/2).
  struct Shared {
    std::complex<double> minus;
    std::complex<double> scale;
    std::complex<double> cotangent;
  };
  [[nodiscard]] Shared shared() const;
  [[nodiscard]] double haar_at(const Shared& shared, double m, Slope& slope) const;
  [[nodiscard]] std::complex<double> weight_slope() const;
  [[nodiscard]] std::complex<double> rate_slope() const;

  double rate_;
  double damping_;               ///< zeta = 1/(2 Q)
  double root_;                  ///< sqrt(1 - zeta^2)
  double fall_;                  ///< a
  double turn_;                  ///< b
  std::complex<double> weight_;  ///< C
  std::complex<double> x_;       ///< a + ib, b folded into (-pi, pi]
  bool folded_ = false;          ///< b is not that of x_
};

}  // namespace driftlab
