#pragma once
/// The battery of checks: what a right baseline would show, and what the recordings show.
///
/// General checks per recording, on block innovations (whiteness, Ljung and Box 1978) and on innovations at full rate
/// (variance over sixteen segments, spectrum in sixteen bands, wavelet variance per scale, kurtosis): chi-square or
/// normal under the model. And one check per cause: its likelihood ratio, whose probability under the model follows
/// from the score (p = 0.05 exp(-(score - threshold)/2) over the whole study). Probabilities are adjusted over all
/// checks of a study by Holm (1979); the chance that any fails without reason is at most 5 %.
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
