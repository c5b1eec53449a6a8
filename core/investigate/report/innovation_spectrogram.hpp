#pragma once
/// How the innovations of one recording change in time and frequency: what a list of departures (remains.hpp) says in
/// sentences, as a picture.
///
/// Under the right model innovations are white and of unit variance, so that their two-sided density is dt at every
/// frequency and at all times. The picture holds the decimal logarithm of the density of each cell of time and band of
/// frequency (core/variance/spectrogram.hpp) over dt. A spectrum that the model lacks but that stays the same is no
/// part of it: innovations are whitened by what was measured. Innovations are cut at six standard deviations first, as
/// one gross value would fill its cell at every frequency.
#include "core/investigate/fullrate/full_rate.hpp"
#include "core/investigate/report/remainder.hpp"
#include "core/investigate/report/report.hpp"

#include <optional>
#include <vector>

namespace driftlab::investigate {

/// Of the recording whose departure in time or frequency is the least likely one of the channel's; nothing where no
/// recording was tested for one. `remains` are those of this channel. O(samples).
[[nodiscard]] std::optional<InnovationSpectrogram> spectrogram_of_innovations(const ChannelGroup& group,
                                                                              const FullRate& data,
                                                                              const std::vector<Remainder>& remains);

}  // namespace driftlab::investigate
