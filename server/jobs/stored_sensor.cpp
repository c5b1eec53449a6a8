#include "server/jobs/stored_sensor.hpp"

#include "core/analysis/modelled_sensor.hpp"
#include "core/signal/angle.hpp"
#include "schema/json/error_model.hpp"
#include "schema/json/simulation_model.hpp"

#include <array>
#include <optional>
#include <string_view>

namespace driftlab::server {
namespace {

constexpr std::array kAxes{"x", "y", "z"};

/// Where in a scenario a sensor stands.
struct Place {
  bool truth = false;
  bool gyro = false;
  std::size_t axis = 3;  ///< 3: the whole sensor
};

Place place_of(const std::string& pointer) {
  Place place;
  place.truth = pointer.find("/truth/") != std::string::npos;
  place.gyro = pointer.find("/gyro") != std::string::npos;
  for (std::size_t k = 0; k < 3; ++k) {
    if (pointer.ends_with(std::string("/") + kAxes[k])) {
      place.axis = k;
    }
  }
  return place;
}

std::string within_scenario(const std::string& pointer) {
  constexpr std::string_view kScenario = "/inputs/scenario";
  return pointer.starts_with(kScenario) ? pointer.substr(kScenario.size()) : pointer;
}

/// The stored model `id`; empty after a fault at `pointer` (there is none, or it cannot be read). The error is the
/// store's.
Result<std::optional<investigate::Baseline>> stored_model(const std::string& id, Store& store,
                                                          const std::string& pointer, Faults& faults) {
  auto stored = store.model(id);
  if (!stored && stored.error().code != ErrorCode::NotFound) {
    return fail(stored.error());
  }
  auto document = stored ? parse_json(stored->document_json) : Result<Json>(Json::object());
  if (!stored || !document || !document->contains("processes")) {
    faults.add(pointer, ErrorCode::NotFound, "There is no simulation model " + id + ".");
    return std::nullopt;
  }
  Faults within;
  investigate::Baseline model = simulation_model_from_json(*document, "", within);
  if (!within.none()) {
    faults.add(pointer, within.error());
    return std::nullopt;
  }
  return model;
}

}  // namespace

Status resolve_simulation_model(Json& sensor, const std::string& pointer, Store& store, StoredSensors& found,
                                Faults& faults) {
  const Place place = place_of(pointer);
  const char* const bias_member = place.gyro ? "constant_bias_sd_deg_s" : "constant_bias_sd_mg";
  ObjectReader reader(sensor, pointer, faults);
  const std::string id = reader.required_text("simulation_model");
  const std::string named = reader.text("channel").value_or("");
  const std::optional<double> bias_sd = reader.real(bias_member);
  reader.reject_unknown();
  const auto stored = stored_model(id, store, pointer + "/simulation_model", faults);
  if (!stored) {
    return fail(stored.error());
  }
  const auto& model = *stored;
  if (!model) {
    return {};
  }
  ScenarioSensor asked{place.gyro, place.truth, {0, 1, 2}, named};
  if (place.axis < kAxes.size()) {
    asked.axes = {place.axis};
  }
  const auto made = sensor_of_model(*model, asked);
  if (!made) {
    faults.add(made.error().code == ErrorCode::UnitMismatch ? pointer : pointer + "/channel", made.error());
    return {};
  }
  Json axes = Json::object();
  for (const ModelledAxis& one : made->axes) {
    Json axis{{"processes", to_si_json(one.processes)}};
    if (bias_sd) {
      axis[bias_member] = *bias_sd;
    }
    if (place.truth && one.bias != 0.0) {
      Json& list = found.truth_bias[place.gyro ? "gyro_errors" : "accelerometer_errors"];
      list = list.is_null() ? Json{0.0, 0.0, 0.0} : list;
      list[one.axis] = one.bias / (place.gyro ? kDegree : 1.0);
    }
    axes[kAxes[one.axis]] = std::move(axis);
  }
  if (!made->left_out.empty()) {
    found.left_out.push_back(
        Json{{"where", within_scenario(pointer)}, {"simulation_model", id}, {"what", made->left_out}});
  }
  sensor = place.axis < kAxes.size() ? Json(axes[kAxes[place.axis]]) : std::move(axes);
  return {};
}

}  // namespace driftlab::server
