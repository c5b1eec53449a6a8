#pragma once
/// Whether the codes of a coarse output come as often as they should: the differential nonlinearity of a converter,
/// whose codes are not all of one width (IEEE 1241).
///
/// Values of a lattice are whole numbers k of its step. Where the noise has a standard deviation of s steps, the phase
/// of k over p codes is uniform but for exp(-2 pi^2 s^2/p^2), whatever the motion. Over n samples that are independent
/// within p codes x = |sum exp(2 pi i k/p)|^2/n has an exponential distribution of mean 1, for each period
/// p = 32/j, j = 1 to 16, whose exponent is at least kApart. A code in every p that is wider or narrower by a share a
/// has x = n a^2/4 and more. s is that of the quietest stretch: of noise that is small against the step somewhere, or
/// that has a sharper peak than a Gaussian, nothing can be said.
#include "core/investigate/report/remainder.hpp"
#include "core/investigate/search/group_search.hpp"

namespace driftlab::investigate {

/// The strongest period of the counts of codes in all recordings of a channel; none where its values have no lattice,
/// or one whose step is below a fiftieth of the noise, for that is the last digit written and no code. O(n).
[[nodiscard]] Remainder uneven_codes(const ChannelGroup& group, const FullRate& data);

}  // namespace driftlab::investigate
