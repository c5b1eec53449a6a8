#pragma once
/// Whether a name is earned.
///
/// The best cause of a list is not a right cause: an effect that stands in no list is described best by some cause that
/// does. A finding is therefore left open to something unnamed (Evidence::doubt) if
///   - a parameter is at the bound of its search, or a time constant longer than twenty recordings;
///   - a bias that differs from recording to recording differs in one alone, of four or more: more than 95 % of the sum
///     of squares about the median is one recording's;
///   - as many checks fail with the extended model as half of those that failed before, and three or more;
///   - noise still changes in time or frequency, on the finding's channel, with p < 0.001 over the study (remains.hpp).
/// Facts of files and recordings speak for themselves and are not doubted.
#include "core/investigate/report/remains.hpp"
#include "core/investigate/report/report.hpp"

#include <vector>

namespace driftlab::investigate {

/// Mean of each recording of a channel under the base alone.
[[nodiscard]] std::vector<double> means_of(const FullRate& before);

/// Sets `doubt` and `ambiguous` of what was found. `means`: of every group (`means_of`). `report` holds the counts of
/// failed checks.
void doubt_what_is_not_earned(const std::vector<ChannelGroup>& groups, const std::vector<std::vector<double>>& means,
                              const std::vector<Remainder>& remains, const Report& report,
                              std::vector<Evidence>& found);

}  // namespace driftlab::investigate
