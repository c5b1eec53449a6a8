#include "server/jobs/stored_population.hpp"

#include "server/jobs/axis_sources.hpp"

#include <utility>

namespace driftlab::server {
namespace {

constexpr int kDevicesAtOnce = 100;

Result<std::vector<Device>> devices_of_model(Store& store, const std::string& model) {
  std::vector<Device> found;
  std::string after;
  while (true) {
    auto page = store.devices({}, Page{after, kDevicesAtOnce});
    if (!page) {
      return fail(page.error());
    }
    for (Device& device : *page) {
      after = device.id;
      if (is_of_model(model, std::vector<std::string>{device.model, device.imu})) {
        found.push_back(std::move(device));
      }
    }
    if (page->size() < static_cast<std::size_t>(kDevicesAtOnce)) {
      return found;
    }
  }
}

/// What is stored of a device's gyroscope and accelerometer, axis by axis.
Result<DeviceSensors> sensors_of(Store& store, const Device& device, std::optional<Quantity> wanted) {
  DeviceSensors found{device.name, {}};
  for (const Quantity quantity : {Quantity::AngularRate, Quantity::SpecificForce}) {
    for (const char* const axis : {"x", "y", "z"}) {
      if (wanted && *wanted != quantity) {
        continue;
      }
      const std::string name(driftlab::name_of(quantity));
      const auto results = store.axis_results({device.id, name, axis});
      auto sources = results ? sources_of(*results) : fail(results.error());
      if (!sources) {
        return fail(sources.error());
      }
      found.sensors.push_back({name, axis, std::move(*sources)});
    }
  }
  return found;
}

}  // namespace

Result<PopulationReport> stored_populations(Store& store, const std::string& model, std::optional<Quantity> quantity) {
  const auto devices = devices_of_model(store, model);
  if (!devices) {
    return fail(devices.error());
  }
  if (devices->empty()) {
    return fail(ErrorCode::NotFound,
                "No device has the model or IMU '" + model +
                    "'; say it of your devices with PATCH /v1/devices/{id} and \"model\" or \"imu\".");
  }
  std::vector<DeviceSensors> sensors;
  for (const Device& device : *devices) {
    auto found = sensors_of(store, device, quantity);
    if (!found) {
      return fail(found.error());
    }
    sensors.push_back(std::move(*found));
  }
  return compare_devices(model, sensors, quantity);
}

}  // namespace driftlab::server
