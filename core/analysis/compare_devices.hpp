#pragma once
/// The use case "compare devices": results of the devices of a model in; mean, spread and outliers of each parameter
/// out (core/campaign/population_report.hpp).
#include "core/campaign/population_report.hpp"
#include "core/campaign/sensor_sources.hpp"

#include <optional>
#include <string>
#include <vector>

namespace driftlab {

/// What is known of one device, by sensor axis.
struct DeviceSensors {
  std::string device;
  std::vector<SensorSources> sensors;
};

/// Each gyroscope and accelerometer axis counts by its table from the Allan variance; an axis without results, or whose
/// recordings are in units that do not convert into each other, has none and is left out. `wanted`: that sensor alone.
/// Cost: some ms a device.
[[nodiscard]] PopulationReport compare_devices(const std::string& model, const std::vector<DeviceSensors>& devices,
                                               std::optional<Quantity> wanted = std::nullopt);

}  // namespace driftlab
