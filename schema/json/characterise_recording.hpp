#pragma once
/// From a recording's samples to its characterisation document: the one path that CLI and daemon share.
#include "core/calibrate/sensor_calibration.hpp"
#include "core/fit/characterise.hpp"
#include "core/signal/recording_view.hpp"
#include "schema/json/json.hpp"

#include <string>

namespace driftlab {

/// One member of `recordings` of the characterisation document (spec/results.md). Readings are corrected by the
/// calibration, where there is one, and references put in time (core/calibrate/aligned_reference.hpp); both change
/// `view`. Channels are characterised in file order; progress runs over them all. Errors: those of apply_calibration;
/// those of characterise_channel, with field "column".
[[nodiscard]] Result<Json> characterise_recording(const std::string& id, const RecordingSpec& spec, RecordingView& view,
                                                  const Calibration& calibration, const CharacteriseOptions& options,
                                                  const RunControl& control);

/// Settings as stored with each result: models, seed, algorithm version.
[[nodiscard]] Json to_json(const CharacteriseOptions& options);

/// `parameters` of a characterise job. Unknown members and values out of range are faults.
[[nodiscard]] CharacteriseOptions characterise_options_from_json(const Json& document, const std::string& pointer,
                                                                 Faults& faults);

}  // namespace driftlab
