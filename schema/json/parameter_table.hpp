#pragma once
/// The document of a parameter table (schema/parameter-table.schema.json).
#include "core/campaign/parameter_table.hpp"
#include "schema/json/json.hpp"

namespace driftlab {

[[nodiscard]] Json to_json(const ParameterTable& table);

}  // namespace driftlab
