#pragma once
/// The scenario of an outage evaluation as a document; schema/outage-scenario.schema.json is its machine-readable form.
///
/// Models are given as processes (schema/json/error_model.hpp), by bands of |rate| or not, or named: the published
/// model and the six filters of the seed paper's comparison by their sentences ("WN + 2 GM of Table 4, experiment 0").
#include "core/navigate/outage_evaluation.hpp"
#include "schema/json/json.hpp"

namespace driftlab {

/// Faults are added at `pointer` and below; the result is then unspecified. Members that people write for people
/// (`about`, `variants`) are accepted and ignored.
[[nodiscard]] OutageScenario scenario_from_json(const Json& document, const std::string& pointer, Faults& faults);

/// The scenario with every model spelled out; reading it gives the same scenario up to the rounding of units.
[[nodiscard]] Json to_json(const OutageScenario& scenario);

/// A scenario by name, or a whole document: what `scenario` of a request may be.
[[nodiscard]] OutageScenario scenario_or_name(const Json& value, const std::string& pointer, Faults& faults);

}  // namespace driftlab
