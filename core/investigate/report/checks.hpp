#pragma once
/// All checks of the baseline and of the extended model, corrected for their number, and the explanation of each failed
/// check: a finding, the extended model, or none.
///
/// General checks test for no particular cause (general_checks.hpp). They are made under the baseline that knows of no
/// effect and, where something was found, once more under the extended model.
///
/// There is one check per cause and channel that was examined: its likelihood ratio, at first sight and once more when
/// the search ended. Each score includes a penalty for the places that the search tried, and the threshold is set so
/// that at most 5 % of studies without any effect reach it with any cause (search/thresholds.hpp). Among `c` such
/// checks of a study the probability of one is therefore taken to be
///   p = 0.05 exp(-(score - threshold)/2) / c.
/// Facts that the file itself shows (a lattice, runs of one value, absent samples) are certain and have p = 0.
///
/// Holm's correction (1979) is applied once, to all checks of the study together: general ones and those of causes, for
/// every recording and channel, before and after. The probability that any of them fails without reason is at most 5 %.
/// A finding is reported by its score, so one that only just passes the threshold may stand beside a check that does
/// not fail. A check that fails ends in a finding, or is mended by the extended model, or is unexplained.
#include "core/investigate/report/general_checks.hpp"
#include "core/investigate/report/report.hpp"
#include "core/investigate/search/group_search.hpp"

#include <string>
#include <vector>

namespace driftlab::investigate {

/// The general checks of one channel's samples.
struct ChannelChecks {
  std::vector<Check> checks;             ///< the general ones, before and after; `p` is not adjusted
  std::vector<InnovationMoments> after;  ///< of each recording under the extended model
};

/// Of a channel that has been searched; empty where it could not be. O(samples log samples).
[[nodiscard]] ChannelChecks check_channel(const ChannelGroup& group, const GroupOutcome& outcome);

/// Fills `checks`, `failed_before`, `failed_after`, `misfit_after` and `unexplained` of the report. `channels`: of
/// every group; of the outcomes no sample is looked at.
void make_checks(const std::vector<ChannelGroup>& groups, const std::vector<GroupOutcome>& outcomes,
                 const std::vector<ChannelChecks>& channels, const std::vector<Evidence>& examined, Report& report);

/// Ids of the checks that speak for a finding: its own first, then failed general ones of its recordings and channels.
[[nodiscard]] std::vector<std::string> checks_behind(const Evidence& evidence, const std::vector<ChannelGroup>& groups,
                                                     const Report& report);

/// Sets for every check whether it ends in a finding, is mended by the extended model or stays unexplained; needs
/// `because` of all findings.
void settle_ends(Report& report);

}  // namespace driftlab::investigate
