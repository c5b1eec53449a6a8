#pragma once
/// The provisional results of a growing recording, as the data of an event.
#include "core/analysis/growing_recording.hpp"
#include "schema/json/json.hpp"

namespace driftlab {

/// Deviations in the channel's own unit, N in that of the laboratory.
[[nodiscard]] Json growing_recording_to_json(const GrowingRecording& look, const Unit& unit);

}  // namespace driftlab
