#pragma once
/// The gain of an effect on samples to which it was not fitted.
#include "core/investigate/causes/evidence.hpp"
#include "core/investigate/fullrate/full_rate.hpp"

namespace driftlab::investigate {

/// Sets the held-out members of `found`. The data are divided into two folds of alternating segments (for spectra and
/// lines, into the halves of each recording). The cause is fitted to one fold, its gain in log likelihood is counted on
/// the other, and then the folds change roles.
void hold_out(const FullRate& data, Evidence& found);

}  // namespace driftlab::investigate
