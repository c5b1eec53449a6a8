#pragma once
/// The spectrum of a recording at full rate, and the Whittle likelihood of models for it.
///
/// P(f_k) = dt/n |sum e_t exp(-i 2 pi k t/n)|^2 is averaged over bins of 2.5 % in frequency (at least one ordinate);
/// with m ordinates in a bin, P/E is near a Gamma(m)/m and the log likelihood of a density E is - sum m [ln E + P/E]
/// (Whittle 1953). E is the *expected* periodogram of a finite record, a law of each slow process
/// (core/process/slow_law.hpp): a Gauss-Markov process leaks, and a random walk shows twice its density.
#include "core/investigate/slow/slow_model.hpp"

#include <complex>
#include <stop_token>
#include <vector>

namespace driftlab::investigate {

struct Spectrum {
  double dt_s = 0.0;
  std::size_t samples = 0;     ///< samples transformed: the longest length up to the record's with factors 2, 3, 5
  std::vector<double> f_hz;    ///< mean frequency per bin
  std::vector<double> power;   ///< mean P per bin [SI^2 s]
  std::vector<double> weight;  ///< ordinates m per bin
  double broken = 0.0;         ///< share of the samples that gaps keep from following their neighbours (gaps.hpp)
};

/// The largest number up to `n` whose only factors are 2, 3 and 5.
[[nodiscard]] std::size_t fast_length(std::size_t n);

/// Discrete Fourier transform of a real series zero-padded to `length` (0: its own): length/2 + 1 values, which mean
/// nothing once `stop` is asked.
[[nodiscard]] std::vector<std::complex<double>> half_spectrum_of(const Series& values, std::size_t length = 0,
                                                                 const std::stop_token& stop = {});

/// Spectrum of `error` from `f_low_hz` up to, not including, the Nyquist frequency; its mean is removed. No bins once
/// `stop` is asked.
[[nodiscard]] Spectrum estimate_spectrum(const Series& error, double dt_s, double f_low_hz,
                                         const std::stop_token& stop = {});

/// Expected periodogram of the slow components of recording r (without the white part).
[[nodiscard]] double slow_density(const SlowModel& model, std::size_t r, double f_hz, double dt_s, double samples);

/// Squared gain of the second-order Butterworth low-pass in its bilinear form: 1/(1 + (tan(pi f dt)/tan(pi fc dt))^4).
[[nodiscard]] double butterworth_gain(double f_hz, double corner_hz, double dt_s);

/// Density shape of quantisation noise with Q = 1: |1 - exp(-i w)|^2 / dt [s].
[[nodiscard]] double quantization_shape(double f_hz, double dt_s);

}  // namespace driftlab::investigate
