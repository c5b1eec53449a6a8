#pragma once
/// The pooled document of one sensor axis (schema/pooled-sensor.schema.json) and back.
#include "core/campaign/pooled_sensor.hpp"
#include "schema/json/json.hpp"

namespace driftlab {

[[nodiscard]] Json to_json(const PooledSensor& pooled);

/// Whether one structure serves every condition, with the candidates that were compared.
[[nodiscard]] Json to_json(const PooledStructure& structure);

/// null where there is nothing to compare. A test over averaged parameters has a whole number of degrees of freedom.
[[nodiscard]] Json to_json(const std::optional<RecordingAgreement>& agreement);

/// Error: Internal, for a document that driftlab has not written.
[[nodiscard]] Result<PooledSensor> pooled_sensor_from_json(const Json& document);

}  // namespace driftlab
