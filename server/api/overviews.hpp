#pragma once
/// A device at a glance: how many recordings under which conditions, the white noise of each axis, whether its model
/// fits.
#include "schema/json/json.hpp"
#include "server/store/store.hpp"

#include <string>

namespace driftlab::server {

/// The document of GET /v1/devices/{id}/summary. Errors: those of the store.
[[nodiscard]] Result<Json> device_summary(Store& store, const std::string& device_id);

}  // namespace driftlab::server
