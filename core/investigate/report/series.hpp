#pragma once
/// The series that a figure of a finding needs: what was measured against what the models simulate, before and after.
///
/// Three views of one recording. Scales: Haar wavelet deviation by scale (non-overlapping coefficients, so that their
/// squares are nearly independent) with the 95 % band of a chi-square of as many degrees of freedom. Spectrum:
/// two-sided density of the error in bins. Course: means over at most 200 stretches of time. "Before" is the error
/// under the baseline, "after" what is left when every effect on the mean that was found is taken off, with the
/// extended model's slow noise; causes that change the level or distribution of the white part show in "before" against
/// "baseline".
#include "core/investigate/report/report.hpp"
#include "core/investigate/search/group_search.hpp"

#include <cstddef>

namespace driftlab::investigate {

/// Of member `r` of the group. O(samples log samples).
[[nodiscard]] FindingSeries series_of(const ChannelGroup& group, const GroupOutcome& outcome, std::size_t r);

}  // namespace driftlab::investigate
