#pragma once
/// What knowing a fact of the file gains on the half of each recording from which it was not read.
#include "core/investigate/causes/evidence.hpp"
#include "core/investigate/study/study.hpp"

#include <vector>

namespace driftlab::investigate {

/// Absent, stuck and clipped samples are events: the log score of their rate in one half, on the other half, against
/// the rate of one event per recording that the simulation's "never" is given. A fact may declare a log likelihood of
/// its own instead (FileFact::log_gain), or neither, and then has no such score. `spoilt[r]` marks the samples that the
/// fact has spoilt.
void hold_out_fact(const ChannelGroup& group, const std::vector<std::vector<unsigned char>>& spoilt, Evidence& found);

}  // namespace driftlab::investigate
