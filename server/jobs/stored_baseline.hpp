#pragma once
/// A baseline that names a stored model or fit, with that in its place.
#include "schema/json/json.hpp"
#include "server/store/store.hpp"

#include <string>

namespace driftlab::server {

/// `baseline` of a study (spec/study.md) as a document that stands by itself: {"kind": "auto"} or {"kind": "model",
/// ...}.
/// `{"kind": "model", "id": "mod_..."}` and `{"kind": "fit", "id": "fit_..."}` are looked up. Faults (NotFound) are
/// added at `pointer` and below; the error is that of the store.
[[nodiscard]] Result<Json> stored_baseline(const Json& baseline, Store& store, const std::string& pointer,
                                           Faults& faults);

}  // namespace driftlab::server
