#pragma once
/// Power spectral density of a record in the bins that a figure asks for, with what a mean over a bin would hide.
///
/// The estimate is that of core/variance/power_spectrum.hpp, five sine tapers, as a two-sided density [unit^2/Hz]: of
/// white noise N^2. A record longer than 2^20 samples is cut into segments of that length, at most 32 of them, evenly
/// spread; their eigenspectra are averaged, and frequencies below 1/(2^20 dt) are not shown. In each bin stand the mean
/// over its Fourier frequencies, with a chi-square interval for Gaussian noise, and the greatest of them: a line of one
/// ordinate that a mean over hundreds does not show.
#include "core/signal/estimate.hpp"
#include "core/signal/progress.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace driftlab {

enum class FrequencyScale { Log, Linear };

struct BinnedSpectrum {
  std::vector<double> frequency_hz;  ///< mean of each bin's Fourier frequencies, rising
  std::vector<double> density;       ///< two-sided [unit^2/Hz]
  std::vector<Interval> ci95;
  std::vector<double> greatest;  ///< of the ordinates in the bin [unit^2/Hz]
  std::size_t segments = 0;
  std::size_t segment_samples = 0;
};

/// At most `bins` >= 1 bins of equal width on `scale`, none without a Fourier frequency. `samples` are uniform at dt_s,
/// free of NaN and bounded, `pivot` near their mean; fewer than 64 samples: empty. Empty if a stop was requested.
/// O(N log N) time of at most 2^25 samples, 80 MB of memory at most.
[[nodiscard]] BinnedSpectrum binned_spectrum(std::span<const double> samples, double pivot, double dt_s,
                                             FrequencyScale scale, std::size_t bins, const RunControl& control = {});

}  // namespace driftlab
