#pragma once
/// A drive document (schema/drive.schema.json) as the core takes it, and back.
#include "core/navigate/drive/document.hpp"
#include "schema/json/json.hpp"

namespace driftlab {

/// What a member of a drive names as its source: `file` on this machine, `recording` (an id) on a server. `pointer`:
/// where the document stands in a larger one.
[[nodiscard]] drive::Document drive_from_json(const Json& document, Faults& faults,
                                              std::string_view source_member = "file", const std::string& pointer = "");

/// `gyroscope` and `accelerometer` of a model.
[[nodiscard]] ImuModel drive_model_from_json(const Json& document, const std::string& pointer, Faults& faults);

}  // namespace driftlab
