#include "schema/json/data_sheet.hpp"

namespace driftlab {
namespace {

Json span_to_json(const StatedSpan& span) { return Json::array({number(span.lowest), number(span.highest)}); }

Json sensor_to_json(const SensorSheet& sensor) {
  const bool rate = sensor.quantity == Quantity::AngularRate;
  Json scales = Json::array();
  for (const FullScale& scale : sensor.scales) {
    scales.push_back(Json{{"limit", number(scale.limit)}});
    if (scale.per_count) {
      scales.back()["per_count"] = number(*scale.per_count);
    }
  }
  Json document{{"sensor", sensor_of(sensor.quantity)},
                {"unit", sensor.unit},
                {"place", sensor.place},
                {"full_scales", std::move(scales)}};
  const auto add = [&](const char* name, const std::optional<double>& value, const std::string& unit) {
    if (value) {
      document[name] = Json{{"value", number(*value)}, {"unit", unit}};
    }
  };
  const std::string density_unit = std::string(sensor.unit) + "/sqrt(Hz)";
  add("noise_density", sensor.noise_density, density_unit);
  add("noise_density_z", sensor.noise_density_z, density_unit);
  add("random_walk", sensor.random_walk, rate ? "deg/sqrt(h)" : "m/s/sqrt(h)");
  add("bias_stability", sensor.bias_stability, rate ? "deg/h" : "ug");
  const ParameterUnit n = lab_unit(rate ? Dimension::AngularRate : Dimension::SpecificForce, 1);
  if (auto stated = stated_density_si(sensor, "")) {
    add("N", *stated * n.per_si, n.symbol);
  }
  if (sensor.bandwidth_hz) {
    document["bandwidth_hz"] = span_to_json(*sensor.bandwidth_hz);
  }
  if (sensor.rate_hz) {
    document["rate_hz"] = span_to_json(*sensor.rate_hz);
  }
  return document;
}

}  // namespace

Json to_json(const DataSheet& sheet) {
  Json sensors = Json::array();
  for (const SensorSheet& sensor : sheet.sensors) {
    sensors.push_back(sensor_to_json(sensor));
  }
  Json also = Json::array();
  for (const std::string_view name : sheet.also) {
    also.push_back(name);
  }
  Json document{{"name", sheet.name},
                {"manufacturer", sheet.manufacturer},
                {"document", sheet.document},
                {"also", std::move(also)},
                {"sensors", std::move(sensors)}};
  if (!sheet.revision.empty()) {
    document["revision"] = sheet.revision;
  }
  return document;
}

Json data_sheets_document(const std::vector<const DataSheet*>& sheets) {
  Json items = Json::array();
  for (const DataSheet* const sheet : sheets) {
    items.push_back(to_json(*sheet));
  }
  return Json{{"items", std::move(items)}, {"next_cursor", nullptr}};
}

}  // namespace driftlab
