#pragma once
/// Power spectral density of a record with intervals, by sine multitapers, and the lines that stand out of it.
///
/// One-sided density [unit^2/Hz], so that its integral over frequency is the variance: of white noise 2 N^2. The whole
/// record is one segment. Its tapers are v_k(t) = sqrt(2/(n + 1)) sin(pi k t/(n + 1)), k = 1 .. 5 (Riedel and Sidorenko
/// 1995), whose eigenspectra all come from one transform X of the record padded to twice its length,
///   S_k(f_j) ~ |X(j - k) - X(j + k)|^2.
/// A bin holds the mean over the tapers and over its Fourier frequencies; bins grow to a twelfth of an octave. Degrees
/// of freedom follow from the correlations of these eigenspectra where the density is even across a bin, and intervals
/// are chi-square for Gaussian noise. The leakage of the tapers falls as f^-4 and stays below a random walk.
///
/// A line is a Fourier frequency whose first eigenspectrum exceeds the density around it (the median of the 64
/// ordinates on either side, without the nearest four) by a factor that noise exceeds anywhere in the record with a
/// probability of 1 %: L with (1 + L/r)^-r = 0.01/(n/2), a chi-square of two degrees over a level known with the
/// relative variance 1/r = 1/41 (Percival and Walden 2020, ch. 10, for a known level). Its amplitude is that of a
/// sinusoid of this frequency. Lines are looked for from 272/T on. A line that wanders by more than the resolution 1/T
/// is not one.
#include "core/signal/estimate.hpp"
#include "core/signal/progress.hpp"

#include <span>
#include <vector>

namespace driftlab {

struct SpectrumLine {
  double frequency_hz = 0.0;
  double amplitude = 0.0;  ///< of the sinusoid [unit]
  double excess = 0.0;     ///< power over that of the noise around it
};

struct PowerSpectrum {
  std::vector<double> frequency_hz;  ///< mean of each bin's Fourier frequencies, rising
  std::vector<double> density;       ///< one-sided [unit^2/Hz]
  std::vector<Interval> ci95;
  std::vector<double> edf;
  std::vector<SpectrumLine> lines;  ///< rising in frequency; at most 32, the strongest
};

/// `samples` are uniform at dt_s, free of NaN and bounded; at least 64 (else empty). `pivot` is near their mean. Of a
/// length whose transform is slow the last samples, below 1 %, are left out. O(N log N) time, 48 bytes a sample. Empty
/// if a stop was requested through `control.stop`, polled between the steps.
[[nodiscard]] PowerSpectrum power_spectrum(std::span<const double> samples, double pivot, double dt_s,
                                           const RunControl& control = {});

}  // namespace driftlab
