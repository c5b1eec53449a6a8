#pragma once
/// Populations of a model as a document: schema/population.schema.json.
#include "core/campaign/population_report.hpp"
#include "schema/json/json.hpp"

namespace driftlab {

[[nodiscard]] Json to_json(const PopulationReport& report);

}  // namespace driftlab
