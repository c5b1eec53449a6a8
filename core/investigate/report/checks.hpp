#pragma once
/// The checks of the baseline: statistics as a right baseline would show them, and as the recordings show them.
///
/// General checks are made per recording. They use the innovations of block means (whiteness, Ljung and Box 1978) and
/// the innovations at full rate (variance over sixteen segments, spectrum in sixteen bands, wavelet variance per scale,
/// kurtosis). They are chi-square or normal under the model, with as many degrees of freedom as segments, lags, bands
/// or coefficients were used.
///
/// There is one check per cause and channel that was examined: its likelihood ratio. Each score includes a penalty for
/// the places that the search tried, and the threshold is set so that at most 5 % of studies without any effect reach
/// it with any cause (search/thresholds.hpp). Among `c` such checks of a study the probability of one is therefore
/// taken to be
///   p = 0.05 exp(-(score - threshold)/2) / c.
/// Facts that the file itself shows (a lattice, runs of one value, absent samples) are certain and have p = 0.
///
/// Holm's correction (1979) is applied to all checks of the study together, the general ones and those of causes for
/// every recording and channel: the probability that any of them fails without reason is at most 5 %. A finding is
/// reported by its score, so one that only just passes the threshold may stand beside a check that does not fail. The
/// general checks under the extended model are a family of their own.
#include "core/investigate/report/report.hpp"
#include "core/investigate/search/group_search.hpp"

#include <string>
#include <vector>

namespace driftlab::investigate {

/// Fills `checks`, `failed_before`, `failed_after`, `misfit_after` and `unexplained` of the report.
void make_checks(const std::vector<ChannelGroup>& groups, const std::vector<GroupOutcome>& outcomes,
                 const std::vector<Evidence>& examined, Report& report);

/// Ids of the checks that speak for a finding: its own first, then failed general ones of its recordings.
[[nodiscard]] std::vector<std::string> checks_behind(const Evidence& evidence, const std::vector<ChannelGroup>& groups,
                                                     const Report& report);

}  // namespace driftlab::investigate
