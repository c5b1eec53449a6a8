#pragma once
/// What people read of a characterisation that another process wrote down.
#include "core/analysis/told_characterisation.hpp"
#include "schema/json/json.hpp"

namespace driftlab {

/// Of a characterisation document: the same as told_of of what it was made of. Error: Internal, for a document that
/// driftlab has not written.
[[nodiscard]] Result<std::vector<ToldRecording>> told_from_json(const Json& document);

}  // namespace driftlab
