#pragma once
/// What a running outage evaluation knows, as a document (schema/outage-evaluation.schema.json, `partial`).
#include "schema/json/json.hpp"

#include <string_view>

namespace driftlab {

/// By the stage of its job: `runs`, `filters`; null where the stage tells none. In outage_evaluation.cpp.
[[nodiscard]] Json partial_outages_json(std::string_view stage);

}  // namespace driftlab
