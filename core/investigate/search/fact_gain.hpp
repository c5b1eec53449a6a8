#pragma once
/// The gain of knowing a fact of the file, on the half of each recording from which the fact was not read.
#include "core/investigate/causes/evidence.hpp"
#include "core/investigate/study/study.hpp"

#include <vector>

namespace driftlab::investigate {

/// Absent, stuck and clipped samples are events. Their rate in one half is scored on the other half against a rate of
/// one event per recording, which stands for the simulation's "never". A fact may instead declare a log likelihood of
/// its own (FileFact::log_gain), or neither, and then has no such score. `spoilt[r]` marks the samples that the fact
/// has spoilt.
void hold_out_fact(const ChannelGroup& group, const std::vector<std::vector<unsigned char>>& spoilt, Evidence& found);

}  // namespace driftlab::investigate
