#pragma once
/// Several models as filters on one drive as a document (schema/drive-evaluation.schema.json, comparison).
#include "core/analysis/drive.hpp"
#include "schema/json/json.hpp"

namespace driftlab {

[[nodiscard]] Json to_json(const DriveComparisonReport& report);

}  // namespace driftlab
