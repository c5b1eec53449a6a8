#include "core/analysis/compare_devices.hpp"

#include <utility>

namespace driftlab {

PopulationReport compare_devices(const std::string& model, const std::vector<DeviceSensors>& devices,
                                 std::optional<Quantity> wanted) {
  std::vector<ParameterTable> tables;
  for (const DeviceSensors& one : devices) {
    for (const SensorSources& sensor : one.sensors) {
      const auto quantity = parse_quantity(sensor.quantity);
      if (!quantity || *quantity == Quantity::Unspecified || (wanted && *wanted != *quantity)) {
        continue;
      }
      if (auto table =
              build_parameter_table({one.device, *quantity, sensor.axis, TableMethod::Av, ""}, sensor.sources)) {
        tables.push_back(std::move(*table));
      }
    }
  }
  return describe_populations(model, tables);
}

}  // namespace driftlab
