#pragma once
/// What a finding at full rate leaves: the data as they look once it is part of the model.
///
/// Innovations are divided by the deviation found, or become normal scores under the distribution found; spectra lose
/// the density it adds, so that the next cause is not credited with the same power.
#include "core/investigate/causes/evidence.hpp"
#include "core/investigate/fullrate/full_rate.hpp"

namespace driftlab::investigate {

/// A finding that states a deviation, or a distribution (NoiseLevel::deviation, NoiseTails::tail); anything else leaves
/// the data as they are.
void take_out(FullRate& data, const Evidence& found);

/// N^2 at full rate: the mean of spectrum minus slow part over all recordings.
[[nodiscard]] double white_at_full_rate(const FullRate& data);

/// N^2 below half the corner of a band limit: the density that the filter keeps.
[[nodiscard]] double white_below(const FullRate& data, double corner_hz);

/// White level per recording relative to the model in the lower quarter of the band; 1 where it does not differ by two
/// standard errors, empty where that is everywhere. A level that is only slightly off would else pass for a fast
/// Gauss-Markov process.
[[nodiscard]] std::vector<double> white_scale_of(const FullRate& data);

}  // namespace driftlab::investigate
