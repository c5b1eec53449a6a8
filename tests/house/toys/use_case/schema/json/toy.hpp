#pragma once
/// The toy's result as JSON (schema/toy.schema.json).
#include "core/analysis/toy.hpp"
#include "schema/json/json.hpp"

namespace driftlab {

[[nodiscard]] Json to_json(const ToyReport& report);

}  // namespace driftlab
