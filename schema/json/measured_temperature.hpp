#pragma once
/// How warm a recording was by its own column, as `temperature` of its quality.
#include "core/signal/measured_temperature.hpp"
#include "schema/json/json.hpp"

namespace driftlab {

/// {"column": "temp", "median_degc": 31.2, "low_degc": 30.1, "high_degc": 31.9}
[[nodiscard]] Json to_json(const MeasuredTemperature& temperature);

}  // namespace driftlab
