#include "schema/json/pooled_sensor.hpp"
#include "schema/json/recording_spec.hpp"
#include "schema/json/trend_table.hpp"

#include <algorithm>

namespace driftlab {

std::vector<SensorSources> sensors_of(const Json& characterisation) {
  std::vector<SensorSources> sensors;
  for (const Json& recording : characterisation.at("recordings")) {
    Faults ignored;
    const std::string condition = to_text(condition_from_json(recording.at("condition"), "", ignored));
    for (const Json& channel : recording.at("channels")) {
      const bool has_axis = channel["axis"].is_string();
      const std::string axis = has_axis ? channel["axis"].get<std::string>() : channel["channel"].get<std::string>();
      const std::string quantity = channel["quantity"].get<std::string>();
      auto sensor = std::find_if(sensors.begin(), sensors.end(),
                                 [&](const SensorSources& s) { return s.quantity == quantity && s.axis == axis; });
      if (sensor == sensors.end()) {
        sensors.push_back({quantity, axis, {}});
        sensor = sensors.end() - 1;
      }
      sensor->sources.push_back({recording["id"].get<std::string>(), condition, channel, ""});
    }
  }
  return sensors;
}

const Json* pooled_of(const Json& characterisation, const SensorSources& sensor) {
  const auto list = characterisation.find("replicates");
  if (list == characterisation.end()) {
    return nullptr;
  }
  for (const Json& pooled : *list) {
    if (pooled["quantity"] == sensor.quantity && pooled["sensor_axis"] == sensor.axis) {
      return &pooled;
    }
  }
  return nullptr;
}

Status add_summary(Json& characterisation, const std::string& device, const std::vector<SensorSources>& sensors,
                   const RunControl& control) {
  Json replicates = Json::array();
  Json trends = Json::array();
  std::size_t done = 0;
  for (const SensorSources& sensor : sensors) {
    const RunControl part{control.stop, [&](std::string_view stage, double fraction) {
                            control.report(
                                stage, (static_cast<double>(done) + fraction) / static_cast<double>(sensors.size()));
                          }};
    ++done;
    if (sensor.sources.size() < 2) {
      continue;
    }
    auto pooled = pool_sensor(sensor.sources, {}, part);
    if (!pooled) {
      if (pooled.error().code == ErrorCode::Cancelled) {
        return fail(pooled.error());
      }
      pooled = Json{{"quantity", sensor.quantity},
                    {"axis", nullptr},
                    {"model", nullptr},
                    {"structure", nullptr},
                    {"conditions", Json::array()},
                    {"reason", pooled.error().message}};
    }
    (*pooled)["sensor_axis"] = sensor.axis;
    const Quantity quantity = parse_quantity(sensor.quantity).value_or(Quantity::Unspecified);
    for (const TableMethod method : {TableMethod::Av, TableMethod::Gmwm}) {
      const auto table = build_parameter_table({device, quantity, sensor.axis, method, ""}, sensor.sources, &*pooled);
      if (table) {
        trends.push_back(build_trends(*table));
      }
    }
    replicates.push_back(std::move(*pooled));
  }
  characterisation["trends"] = std::move(trends);
  characterisation["replicates"] = std::move(replicates);
  return {};
}

}  // namespace driftlab
