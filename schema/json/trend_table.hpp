#pragma once
/// The document of a table's trends (schema/trends.schema.json).
#include "core/campaign/trend_table.hpp"
#include "schema/json/json.hpp"

namespace driftlab {

[[nodiscard]] Json to_json(const TrendTable& table);

}  // namespace driftlab
