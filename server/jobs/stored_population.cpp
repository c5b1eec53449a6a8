#include "server/jobs/stored_population.hpp"

#include "server/jobs/axis_sources.hpp"

#include <set>
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

using Axes = std::set<std::pair<std::string, std::string>>;  ///< quantity and axis

/// Gyroscope and accelerometer, or one of them.
Axes axes_of(std::optional<Quantity> wanted) {
  Axes axes;
  for (const Quantity quantity : {Quantity::AngularRate, Quantity::SpecificForce}) {
    for (const char* const axis : {"x", "y", "z"}) {
      if (!wanted || *wanted == quantity) {
        axes.emplace(driftlab::name_of(quantity), axis);
      }
    }
  }
  return axes;
}

/// Adds those of `fresh` that are of the axis, in the place of what is known of their recordings.
void take_fresh(const SensorAxis& axis, std::span<const ChannelResult> fresh, AxisResults& results) {
  for (const ChannelResult& made : fresh) {
    if (SensorAxis{made.device_id, made.quantity, made.axis} == axis) {
      std::erase_if(results.latest, [&](const ChannelResult& older) {
        return older.recording_id == made.recording_id && older.channel == made.channel;
      });
      results.latest.push_back(made);
    }
  }
}

/// What is known of a device, axis by axis.
Result<DeviceSensors> sensors_of(Store& store, const Device& device, const Axes& axes,
                                 std::span<const ChannelResult> fresh = {}) {
  DeviceSensors found{device.name, {}};
  for (const auto& [quantity, axis] : axes) {
    auto results = store.axis_results({device.id, quantity, axis});
    if (!results) {
      return fail(results.error());
    }
    take_fresh({device.id, quantity, axis}, fresh, *results);
    auto sources = sources_of(*results);
    if (!sources) {
      return fail(sources.error());
    }
    found.sensors.push_back({quantity, axis, std::move(*sources)});
  }
  return found;
}

Result<std::vector<DeviceSensors>> sensors_of_all(Store& store, const std::vector<Device>& devices, const Axes& axes,
                                                  std::span<const ChannelResult> fresh = {}) {
  std::vector<DeviceSensors> sensors;
  for (const Device& device : devices) {
    auto found = sensors_of(store, device, axes, fresh);
    if (!found) {
      return fail(found.error());
    }
    sensors.push_back(std::move(*found));
  }
  return sensors;
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
  const auto sensors = sensors_of_all(store, *devices, axes_of(quantity));
  if (!sensors) {
    return fail(sensors.error());
  }
  return compare_devices(model, *sensors, quantity);
}

Result<std::optional<PopulationReport>> populations_with(Store& store, const std::string& model,
                                                         std::span<const ChannelResult> fresh, std::size_t fewest,
                                                         std::size_t most) {
  Axes axes;
  const Axes all = axes_of(std::nullopt);
  for (const ChannelResult& made : fresh) {
    if (const std::pair axis(made.quantity, made.axis); all.contains(axis)) {
      axes.insert(axis);
    }
  }
  const auto devices = axes.empty() ? Result<std::vector<Device>>() : devices_of_model(store, model);
  if (!devices) {
    return fail(devices.error());
  }
  if (devices->size() < fewest || devices->size() > most) {
    return std::optional<PopulationReport>();
  }
  const auto sensors = sensors_of_all(store, *devices, axes, fresh);
  if (!sensors) {
    return fail(sensors.error());
  }
  return std::optional(compare_devices(model, *sensors, std::nullopt));
}

}  // namespace driftlab::server
