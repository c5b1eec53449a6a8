#pragma once
/// A recording's samples as a screen shows them, as a document (schema/openapi.yaml, getTrace).
#include "core/analysis/draw_trace.hpp"
#include "schema/json/json.hpp"

namespace driftlab {

/// Without `unit`, which is that of the column.
[[nodiscard]] Json to_json(const RecordingTrace& trace);

}  // namespace driftlab
