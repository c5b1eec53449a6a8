#pragma once
/// Oscillations that are not a single spectral line: their frequency runs, or their amplitude is modulated.
///
/// Both are followed in the innovations, which are white and of unit variance under the model. With a phase
/// p(t) = 2 pi (f t + c t^2/2) let S = sum e exp(-i p) over n innovations. Without an oscillation of that phase
/// X = 2 |S|^2 / n is chi-square with two degrees of freedom; where the spectrum of the innovations is locally above 1,
/// X is divided by it. For a phase p0 that is nearly right, sums of e exp(-i p0) over blocks keep all frequencies
/// within half the block rate of p0, so that a trial of a phase near p0 costs one operation per block.
#include "core/investigate/causes/evidence.hpp"
#include "core/investigate/fullrate/full_rate.hpp"

#include <complex>
#include <cstddef>
#include <functional>
#include <vector>

namespace driftlab::investigate {

/// A phase that runs linearly or quadratically in the time from the first analysed sample.
struct Sweep {
  double f_hz = 0.0;        ///< at the first analysed sample
  double slope_hz_s = 0.0;  ///< c
  [[nodiscard]] double phase(double t) const;
  [[nodiscard]] double at(double t) const { return f_hz + slope_hz_s * t; }
};

/// Innovations of member r times exp(-i phase), summed over blocks of samples.
struct Beaten {
  double step_s = 1.0;
  double samples = 0.0;
  std::vector<std::complex<double>> sums;
};
[[nodiscard]] Beaten beat(const FullRate& data, std::size_t r, const Sweep& sweep, std::size_t block);

/// Mean power of the innovations of a recording, 1 where white, over bands of a quarter of a hertz.
class BandPower {
 public:
  BandPower(const FullRate& data, std::size_t r);
  /// Its largest value between two frequencies, at least 1.
  [[nodiscard]] double most_between(double low_hz, double high_hz) const;

 private:
  double df_hz_ = 1.0;
  std::vector<double> sums_;  ///< of the ordinates before each
};

/// ln of the chance that chi-square with 2 k degrees of freedom exceeds x.
[[nodiscard]] double log_tail(double x, double k);

/// Least squares of cosines and sines of several phases in the residuals of member r [SI].
struct PhaseFit {
  std::vector<std::complex<double>> amplitude;  ///< modulus [SI]
  double variance = 0.0;                        ///< of the real and of the imaginary part of each amplitude [SI^2]
  std::vector<double> values;                   ///< over the analysed part
};
[[nodiscard]] PhaseFit fit_phases(const FullRate& data, std::size_t r, const std::vector<Sweep>& sweeps);

/// a b; std::complex looks for values that are not finite as well, which costs three times as much.
[[nodiscard]] inline std::complex<double> times(const std::complex<double>& a, const std::complex<double>& b) {
  return {a.real() * b.real() - a.imag() * b.imag(), a.real() * b.imag() + a.imag() * b.real()};
}

/// The scopes in which such an effect is looked for: all recordings, and each by itself.
[[nodiscard]] std::vector<std::vector<std::size_t>> scopes_of(const FullRate& data);

/// ln of the mean, over a phase that is not known, of the likelihood ratio of a sinusoid of `amplitude`.
[[nodiscard]] double log_gain_of(std::complex<double> fitted, double variance, double amplitude);

}  // namespace driftlab::investigate
