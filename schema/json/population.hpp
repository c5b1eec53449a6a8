#pragma once
/// Populations of a model as a document: schema/population.schema.json.
#include "core/campaign/population_report.hpp"
#include "core/campaign/verdict.hpp"
#include "schema/json/json.hpp"

namespace driftlab {

/// `summary`: what they say (core/campaign/population_verdict.hpp).
[[nodiscard]] Json to_json(const PopulationReport& report, const Verdict& summary);

}  // namespace driftlab
