#include "server/jobs/stored_noise.hpp"

#include "server/jobs/axis_sources.hpp"

namespace driftlab::server {

Result<ImuNoise> stored_noise(Store& store, const std::string& device) {
  auto known = store.device(device);
  if (!known) {
    return fail(known.error());
  }
  std::vector<SensorSources> sensors;
  for (const Quantity quantity : {Quantity::AngularRate, Quantity::SpecificForce}) {
    for (const char* const axis : {"x", "y", "z", ""}) {
      const std::string name(driftlab::name_of(quantity));
      auto results = store.axis_results({known->id, name, axis});
      if (!results) {
        return fail(results.error());
      }
      if (results->latest.empty()) {
        continue;
      }
      auto sources = sources_of(*results);
      if (!sources) {
        return fail(sources.error());
      }
      sensors.push_back({name, axis, std::move(*sources)});
    }
  }
  if (sensors.empty()) {
    return fail(ErrorCode::NotFound,
                "Nothing of device '" + known->name +
                    "' is characterised: upload a recording and queue a job of kind characterise.");
  }
  return imu_noise_of(known->name, sensors, {});
}

}  // namespace driftlab::server
