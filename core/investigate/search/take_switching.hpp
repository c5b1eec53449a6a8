#pragma once
/// Noise that jumps between levels, taken off the error before the noise beside it is judged.
#include "core/investigate/causes/evidence.hpp"
#include "core/investigate/fullrate/full_rate.hpp"

#include <vector>

namespace driftlab::investigate {

/// Looks for switching noise (causes/family.hpp) in the residuals of the slow search. If it is found, the expected
/// level at each sample is subtracted from `error` (per member, over the grid of the whole file) and the evidence is
/// appended to `found`. Samples within 0.5 s of a change of level are added to `mask`, and so are samples whose level
/// is uncertain (expected level below 0.9 of the greatest): there the subtraction leaves an error that is not the
/// sensor's noise.
void take_switching(const FullRate& data, std::vector<Series>& error, std::vector<std::vector<unsigned char>>& mask,
                    std::vector<Evidence>& found);

}  // namespace driftlab::investigate
