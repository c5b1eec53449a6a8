#pragma once
/// How the power spectral density of a record changes with time.
///
/// The record is cut into cells of equal length. In each, Hann windows of one length that overlap by half are
/// transformed and averaged (Welch 1967), 16 of them at most, evenly spread; their ordinates are averaged in bands of
/// equal width in the logarithm of frequency. The window is the largest power of two that fits into a cell, at most
/// 4096 samples, so the lowest band begins at one cycle per window. Two-sided density [unit^2/Hz], as in
/// core/variance/binned_spectrum.hpp.
#include "core/signal/progress.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace driftlab {

struct Spectrogram {
  std::vector<double> time_s;        ///< middle of each cell since the first sample
  std::vector<double> frequency_hz;  ///< mean of each band's Fourier frequencies, rising
  std::vector<double> density;       ///< cells x bands, cell by cell
  std::size_t window_samples = 0;
};

/// At most `cells` cells and `bands` bands, both >= 1: fewer where a cell would have under 32 samples or a band no
/// Fourier frequency. `samples` are uniform at dt_s and finite, `pivot` near their mean. Empty for fewer than 64
/// samples and where a stop was requested. O(cells) transforms of at most 16 windows each.
[[nodiscard]] Spectrogram spectrogram(std::span<const double> samples, double pivot, double dt_s, std::size_t cells,
                                      std::size_t bands, const RunControl& control = {});

}  // namespace driftlab
