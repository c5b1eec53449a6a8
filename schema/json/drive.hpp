#pragma once
/// What a drive shows as documents (schema/drive-evaluation.schema.json).
#include "core/analysis/drive.hpp"
#include "schema/json/json.hpp"

namespace driftlab {

[[nodiscard]] Json to_json(const DriveCheck& checked);
[[nodiscard]] Json to_json(const DriveReport& report);
[[nodiscard]] Json to_json(const DriveExplanationReport& report);
[[nodiscard]] Json to_json(const DriveSimulationReport& simulation);
[[nodiscard]] Json to_json(const drive::DurationSummary& duration, const drive::Drive& drive);

}  // namespace driftlab
