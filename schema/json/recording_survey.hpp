#pragma once
/// What a survey found, as `quality` of a stored recording (schema/stored-recording.schema.json).
#include "core/analysis/draw_trace.hpp"
#include "core/analysis/survey_recording.hpp"
#include "schema/json/json.hpp"

#include <string>

namespace driftlab {

/// The document of the quality (schema/json/recording_spec.hpp) with `temperature`, `longest_gaps` and, per channel,
/// `rails` and `implausible_at`, each only where there is something to say. Rows count from 1.
[[nodiscard]] Json to_json(const RecordingSurvey& survey);

/// What such a document says of one column for its drawing; the gaps alone for a column that is no sensor.
[[nodiscard]] SurveyedChannel surveyed_channel_from_json(const Json& quality, const std::string& column);

}  // namespace driftlab
