#pragma once
/// The report of an investigation as a document (spec/causes.md).
#include "core/investigate/report/report.hpp"
#include "schema/json/json.hpp"

namespace driftlab {

/// The report document of spec/causes.md.
[[nodiscard]] Json to_json(const investigate::Report& report);

/// What one finding changes in the baseline model, and why: cause, status, channels, explanation, gain.
[[nodiscard]] Json change_json(const investigate::Finding& finding);

/// The findings in one line each: cause, status, channels, gain.
[[nodiscard]] Json findings_summary(const investigate::Report& report);

}  // namespace driftlab
