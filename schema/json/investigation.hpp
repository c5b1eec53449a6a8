#pragma once
/// The report of an investigation as a document (spec/causes.md).
#include "core/investigate/report/report.hpp"
#include "schema/json/json.hpp"

namespace driftlab {

/// The report document of spec/causes.md.
[[nodiscard]] Json to_json(const investigate::Report& report);

}  // namespace driftlab
