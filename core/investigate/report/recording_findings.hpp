#pragma once
/// What is wrong with recordings, in the report: before all other findings, for what follows is of the recordings put
/// right.
#include "core/investigate/report/report.hpp"
#include "core/investigate/search/right_recordings.hpp"

namespace driftlab::investigate {

/// Puts a finding with a check of its own before the others for each fault, and an entry of `unexplained` with a check
/// for each recording that was set aside.
void report_recordings(const RightedRecordings& righted, Report& report);

}  // namespace driftlab::investigate
