#pragma once
/// Differenced uniform noise in an automatic baseline.
///
/// Quantisation noise makes the spectrum rise towards the Nyquist frequency as Q^2 |1 - exp(-i w)|^2 / dt. A base of
/// white noise and slow processes alone fits this as white noise, which leaves the innovations coloured for every later
/// search. If all recordings show the rise, the baseline therefore includes it.
#include "core/investigate/fullrate/full_rate.hpp"

namespace driftlab::investigate {

/// Q^2 [SI^2 s^2] by Whittle's likelihood of the spectra of the recordings at rest (of all where none is); 0 unless
/// each of them shows it by itself, all agree, and the spectra are described with it.
[[nodiscard]] double quantization_of_base(const FullRate& data);

}  // namespace driftlab::investigate
