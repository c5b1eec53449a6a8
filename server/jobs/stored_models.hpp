#pragma once
/// Models of sensors that a document names, with what is stored in their place, so that a request says all by itself.
#include "server/jobs/stored_sensor.hpp"

namespace driftlab::server {

/// Wherever in `node`, at `pointer`, a sensor or an axis is {"fit": "fit_..."}, {"simulation_model": "mod_...", ...} or
/// {"table": {"device", "axis", "method", "model", "schedule", "hysteresis_deg_s", "step_deg_s"}}, what that says is
/// written there. Faults (NotFound, InvalidArgument) are added with their pointers. Errors: those of the store;
/// Conflict for a table whose results are being pooled.
[[nodiscard]] Status resolve_stored(Json& node, const std::string& pointer, Store& store, StoredSensors& sensors,
                                    Faults& faults);

}  // namespace driftlab::server
