#pragma once
/// What knowing a fact of the file gains on the half of each recording from which it was not read.
#include "core/investigate/causes/evidence.hpp"
#include "core/investigate/study/study.hpp"

#include <vector>

namespace driftlab::investigate {

/// Absent, stuck and clipped samples are events: the log score of their rate in one half, on the other half, against
/// the rate of one event per recording that the simulation's "never" is given. A lattice: ln(step / decimals) for every
/// value of the other half that lies on it. `mask[r]` marks the samples that the fact has spoilt. Jitter has no such
/// score.
void hold_out_fact(const ChannelGroup& group, const std::vector<std::vector<unsigned char>>& mask, Evidence& found);

}  // namespace driftlab::investigate
