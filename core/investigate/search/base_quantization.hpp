#pragma once
/// Differenced uniform noise in an automatic baseline.
///
/// A base of white noise and slow processes alone takes the rise of the spectrum towards the Nyquist frequency,
/// Q^2 |1 - exp(-i w)|^2 / dt, for white noise, and whatever is sought in its innovations then meets their colour. The
/// baseline of recordings that all show it has it.
#include "core/investigate/fullrate/full_rate.hpp"

namespace driftlab::investigate {

/// Q^2 [SI^2 s^2] by Whittle's likelihood of the spectra of the recordings at rest (of all where none is); 0 unless
/// each of them shows it by itself, all agree, and the spectra are described with it.
[[nodiscard]] double quantization_of_base(const FullRate& data);

}  // namespace driftlab::investigate
