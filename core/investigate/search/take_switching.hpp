#pragma once
/// Noise that jumps between levels, taken off the error before the noise beside it is judged.
#include "core/investigate/causes/evidence.hpp"
#include "core/investigate/fullrate/full_rate.hpp"

#include <vector>

namespace driftlab::investigate {

/// Looks for switching noise (causes/family.hpp) in what the slow search has left. If there is some, its expected
/// course is subtracted from `error` (per member, over the grid of the whole file), and samples about a change of
/// level, and where it is not known which of the levels it is, are added to `mask`: what is left there is no noise of
/// the sensor. The evidence is appended to `found`.
void take_switching(const FullRate& data, std::vector<Series>& error, std::vector<std::vector<unsigned char>>& mask,
                    std::vector<Evidence>& found);

}  // namespace driftlab::investigate
