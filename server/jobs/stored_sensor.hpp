#pragma once
/// A sensor of a scenario that names a stored simulation model, with what that says in its place.
#include "schema/json/json.hpp"
#include "server/store/store.hpp"

#include <string>

namespace driftlab::server {

/// What the models of a scenario say besides processes.
struct StoredSensors {
  /// Known biases of the truth by `gyro_errors` or `accelerometer_errors`: x, y, z in deg/s or m/s^2.
  Json truth_bias = Json::object();
  /// [{"where" (a pointer within the scenario), "simulation_model", "what": [...]}]: effects that a scenario cannot
  /// hold, and biases that a filter cannot know.
  Json left_out = Json::array();
};

/// `sensor` is {"simulation_model": "mod_...", "channel": "gz", "constant_bias_sd_...": ...} at `pointer`, which ends
/// with .../gyro or .../accelerometer, or with an axis of one. Its channel is the named one; without a name gx, gy, gz
/// of a gyroscope and fx, fy, fz of an accelerometer, the only one, or, of a model that does not tell channels apart,
/// every one. A drift becomes the process linear_drift. Faults (NotFound, InvalidArgument) are added at `pointer` and
/// below; the error is that of the store.
[[nodiscard]] Status resolve_simulation_model(Json& sensor, const std::string& pointer, Store& store,
                                              StoredSensors& found, Faults& faults);

}  // namespace driftlab::server
