#pragma once
/// What colours the noise of single samples beside the model's slow processes: a band limit, and peaks of the spectrum.
#include <algorithm>
#include <cstddef>
#include <functional>
#include <limits>

namespace driftlab::investigate {

/// The colours that have been found in a channel group. None: white noise up to half the sample rate.
struct NoiseColour {
  double corner_hz = 0.0;  ///< of a low-pass on the white noise, half power (spectrum.hpp, butterworth_gain); 0: none
  /// Density [SI^2/Hz] that all peaks together add to the spectrum of member r at f [Hz]. Null: none.
  std::function<double(std::size_t r, double f_hz)> peak;
  double peak_hz = 0.0;  ///< the lowest frequency of such a peak; 0: none

  /// True if a band limit has been found, which explains the lower density at the top of the band.
  [[nodiscard]] bool band_limited() const { return corner_hz > 0.0; }

  /// Up to where the spectra show the density that is integrated: half the frequency of the lowest peak.
  [[nodiscard]] double flat_below_hz() const {
    // [Hz] Chosen, not measured: below it slow noise is expected to lie above the white level, whatever the peak.
    constexpr double kLeast = 1.0;
    return peak_hz > 0.0 ? std::max(kLeast, 0.5 * peak_hz) : std::numeric_limits<double>::infinity();
  }
};

}  // namespace driftlab::investigate
