#pragma once
/// The draft of a drive document (core/analysis/draft_drive.hpp) as drive_from_json (drive_document.hpp) reads it.
#include "core/analysis/draft_drive.hpp"
#include "schema/json/json.hpp"

namespace driftlab {

/// Without the notes.
[[nodiscard]] Json to_json(const DriveDraft& draft);

}  // namespace driftlab
