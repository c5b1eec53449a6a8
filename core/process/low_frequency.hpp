#pragma once
/// What a process is at frequencies far below its own: white noise of one density.

namespace driftlab {

/// White noise, band-limited noise and a process that reverts within a few samples leave the same at low frequencies, a
/// density that depends on no frequency. Its root is the N of a data sheet (angle or velocity random walk), and the
/// densities of independent processes add. Aliases are part of it: it is the density that the samples have, not that of
/// what was sampled.
struct LowFrequencyDensity {
  double density = 0.0;  ///< two-sided, at frequency zero [unit^2 s]
  /// Up to here the density is within a tenth of that [Hz]; infinite where it is equal at all frequencies. Below a
  /// recording's lowest frequencies the process is a slow bias to it, not noise.
  double flat_to_hz = 0.0;
};

}  // namespace driftlab
