#pragma once
/// The series for the figure of a finding: the measured data and the simulations of the models, before and after.
///
/// There are three views of one recording. Scales: the Haar wavelet deviation by scale (non-overlapping coefficients,
/// whose squares are nearly independent) with the 95 % band of a chi-square of as many degrees of freedom. Spectrum:
/// the two-sided density of the error in bins. Course: means over at most 200 stretches of time. "Before" is the error
/// under the baseline. "After" is the error without every mean effect that was found, compared with the extended
/// model's slow noise. Causes that change the level or distribution of the white part show in the comparison of
/// "before" with "baseline".
#include "core/investigate/report/report.hpp"
#include "core/investigate/search/group_search.hpp"

#include <cstddef>

namespace driftlab::investigate {

/// Of member `r` of the group. O(samples log samples).
[[nodiscard]] FindingSeries series_of(const ChannelGroup& group, const GroupOutcome& outcome, std::size_t r);

}  // namespace driftlab::investigate
