#pragma once
/// The study as a document comes in, the report of an investigation goes out (spec/study.md, spec/causes.md).
#include "core/investigate/report.hpp"
#include "core/investigate/study.hpp"
#include "schema/json/json.hpp"

namespace driftlab {

/// {"kind": "auto"} or {"kind": "model", "processes": [...], "channels": [...]}. Faults are added at `pointer` and
/// below; a stored fit (kind "fit") is one here, for only a daemon can look it up.
[[nodiscard]] investigate::Baseline baseline_from_json(const Json& document, const std::string& pointer,
                                                       Faults& faults);

/// The report document of spec/causes.md.
[[nodiscard]] Json to_json(const investigate::Report& report);

}  // namespace driftlab
