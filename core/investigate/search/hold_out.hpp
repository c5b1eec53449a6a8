#pragma once
/// What an effect gains on samples it was not fitted to.
#include "core/investigate/causes/evidence.hpp"
#include "core/investigate/fullrate/full_rate.hpp"

namespace driftlab::investigate {

/// Two folds of alternating segments (for spectra and lines: the halves of each recording). The cause is fitted to one
/// and its log likelihood gain counted on the other, and the other way round; sets the held-out members of `found`.
void hold_out(const FullRate& data, Evidence& found);

}  // namespace driftlab::investigate
