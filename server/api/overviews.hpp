#pragma once
/// A device at a glance: how many recordings under which conditions, the white noise of each axis, whether its model
/// fits.
#include "schema/json/json.hpp"
#include "server/store/store.hpp"

namespace driftlab::server {

/// The document of GET /v1/devices/{id}/summary.
[[nodiscard]] Json device_summary(const DeviceOverview& overview);

}  // namespace driftlab::server
