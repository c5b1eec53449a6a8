#pragma once
/// What a survey found, as `quality` of a stored recording (schema/stored-recording.schema.json).
#include "core/analysis/survey_recording.hpp"
#include "schema/json/json.hpp"

namespace driftlab {

/// The document of the quality (schema/json/recording_spec.hpp) with `temperature`, `longest_gaps` and, per channel,
/// `rails` and `implausible_at`, each only where there is something to say. Rows count from 1.
[[nodiscard]] Json to_json(const RecordingSurvey& survey);

}  // namespace driftlab
