#pragma once
/// The results of a recorded drive as documents (schema/drive-evaluation.schema.json).
#include "core/analysis/drive.hpp"
#include "schema/json/json.hpp"

namespace driftlab {

[[nodiscard]] Json to_json(const DriveCheck& checked);
[[nodiscard]] Json to_json(const DriveReport& report);
[[nodiscard]] Json to_json(const DriveExplanationReport& report);
[[nodiscard]] Json to_json(const DriveSimulationReport& simulation);
[[nodiscard]] Json to_json(const drive::DurationSummary& duration, const drive::Drive& drive);

/// The facts of the drive's files, before any filter runs.
[[nodiscard]] Json facts_to_json(const drive::Drive& drive);
/// With the interval of a bootstrap.
[[nodiscard]] Json estimate_to_json(const Estimate& estimate);
/// The settings of a filter beyond those of the drive document.
[[nodiscard]] Json options_to_json(const drive::FilterOptions& options);

}  // namespace driftlab
