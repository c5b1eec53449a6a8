#pragma once
/// The data after a finding at full rate has become part of the model.
///
/// Innovations are divided by the deviation found, or become normal scores under the distribution found. The density
/// that the finding adds is removed from the spectra, so that the same power is not attributed to a second cause.
#include "core/investigate/causes/evidence.hpp"
#include "core/investigate/fullrate/full_rate.hpp"

#include <limits>

namespace driftlab::investigate {

/// Applies a finding that states a deviation or a distribution (NoiseLevel::deviation, NoiseTails::tail); any other
/// finding leaves the data unchanged.
void take_out(FullRate& data, const Evidence& found);

/// N^2 at full rate: the mean of spectrum minus slow part over all recordings, up to a frequency.
[[nodiscard]] double white_at_full_rate(const FullRate& data,
                                        double below_hz = std::numeric_limits<double>::infinity());

/// N^2 below half the corner of a band limit: the density that the filter keeps.
[[nodiscard]] double white_below(const FullRate& data, double corner_hz);

/// White level per recording relative to the model, in the lower quarter of the band; 1 if it does not differ by two
/// standard errors, and empty if that is so in every recording. Without it a slightly wrong level would be mistaken for
/// a fast Gauss-Markov process.
[[nodiscard]] std::vector<double> white_scale_of(const FullRate& data);

}  // namespace driftlab::investigate
