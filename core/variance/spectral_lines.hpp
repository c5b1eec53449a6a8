#pragma once
/// Where a periodogram has a line or a bump: the frequencies at which a resonance or a sinusoid may be looked for.
///
/// A wavelet variance does not say where the power of an octave lies, so a fit to it invents lines where it lacks a
/// filter. The periodogram does: averaged over Hann windows (Welch 1967) it must exceed twice its median over the
/// octave below and the octave above, at two resolutions that differ fourfold. With at least 32 windows at the finer
/// one, white noise does so at a frequency with a probability of some 10^-7.
#include "core/signal/progress.hpp"

#include <span>
#include <vector>

namespace driftlab {

struct SpectralLine {
  double frequency = 0.0;  ///< of the maximum [cycles per sample]
  double excess = 0.0;     ///< over the local median: at least 2
  bool sharp = false;      ///< no wider than the finer resolution: a sinusoid, not a resonance
};

/// At most `most` lines, strongest first; none in records of fewer than 2048 samples. Windows are of up to 8192
/// samples; at most 512 of them are taken, evenly spread over the record. Constant series have no line. Deterministic.
/// Empty if a stop was requested.
[[nodiscard]] std::vector<SpectralLine> spectral_lines(std::span<const double> samples, double pivot,
                                                       std::size_t most = 6, const RunControl& control = {});

}  // namespace driftlab
