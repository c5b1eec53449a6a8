#pragma once
/// The faults of recordings in the report. They precede all other findings, which hold for the repaired recordings.
#include "core/investigate/report/report.hpp"
#include "core/investigate/search/right_recordings.hpp"

namespace driftlab::investigate {

/// Puts a finding with a check of its own before the others for each fault, and an entry of `unexplained` with a check
/// for each recording that was set aside.
void report_recordings(const RightedRecordings& righted, Report& report);

}  // namespace driftlab::investigate
