#pragma once
/// The preview of a file before it is uploaded, as a document (schema/recording-preview.schema.json).
#include "core/analysis/preview_recording.hpp"
#include "schema/json/json.hpp"

namespace driftlab {

[[nodiscard]] Json to_json(const RecordingPreview& preview);

}  // namespace driftlab
