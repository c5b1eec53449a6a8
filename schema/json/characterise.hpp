#pragma once
/// Request and result of the use case "characterise" as JSON.
#include "core/analysis/characterise.hpp"
#include "schema/json/json.hpp"

namespace driftlab {

/// One member of `recordings` of the characterisation document (spec/results.md).
[[nodiscard]] Json to_json(const CharacterisedRecording& recording);

/// Settings as stored with each result: models, seed, algorithm version.
[[nodiscard]] Json to_json(const CharacteriseOptions& options);

/// `parameters` of a characterise job. Unknown members and values out of range are faults.
[[nodiscard]] CharacteriseOptions characterise_options_from_json(const Json& document, const std::string& pointer,
                                                                 Faults& faults);

}  // namespace driftlab
