#pragma once
/// What was found true of a recording as it came, as `quality` of its documents, and back.
#include "core/signal/recording.hpp"
#include "schema/json/json.hpp"

namespace driftlab {

[[nodiscard]] Json to_json(const Quality& quality);

/// Of a document that driftlab has written, of any age: what it does not say is as if nothing had been found.
[[nodiscard]] Quality quality_from_json(const Json& document);

}  // namespace driftlab
