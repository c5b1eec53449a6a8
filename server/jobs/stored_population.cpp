#include "server/jobs/stored_population.hpp"

#include "server/jobs/stored_recordings.hpp"
#include "server/jobs/stored_table.hpp"

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

/// The tables of a device by Allan variance. Axes without results have none.
Status add_tables(Store& store, const Device& device, std::optional<Quantity> wanted,
                  std::vector<ParameterTable>& tables) {
  for (const Quantity quantity : {Quantity::AngularRate, Quantity::SpecificForce}) {
    for (const char* const axis : {"x", "y", "z"}) {
      if (wanted && *wanted != quantity) {
        continue;
      }
      auto stored = stored_table(store, {device.id, std::string(sensor_of(quantity)), axis, "av", ""});
      if (stored) {
        tables.push_back(std::move(stored->table));
      } else if (stored.error().code != ErrorCode::NotFound && stored.error().code != ErrorCode::InvalidArgument) {
        return fail(stored.error());
      }
    }
  }
  return {};
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
  std::vector<ParameterTable> tables;
  for (const Device& device : *devices) {
    if (auto added = add_tables(store, device, quantity, tables); !added) {
      return fail(added.error());
    }
  }
  return describe_populations(model, tables);
}

}  // namespace driftlab::server
