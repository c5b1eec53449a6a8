#include "server/jobs/stored_sensor.hpp"

#include "core/process/parameter_unit.hpp"
#include "core/signal/angle.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>
#include <vector>

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

const Json* member_of(const Json& document, const char* name, const std::string& column) {
  const auto part = document.find(name);
  if (part == document.end() || !part->is_object()) {
    return nullptr;
  }
  const auto own = part->find(column);
  return own == part->end() ? nullptr : &*own;
}

bool knows(const Json& model, const std::string& column) {
  return member_of(model, "channels", column) != nullptr || member_of(model, "deterministic", column) != nullptr;
}

/// The column of one axis; empty where the model does not tell channels apart, nothing where it is not clear.
std::optional<std::string> column_of(const Json& model, const std::string& named, const Place& place,
                                     std::size_t axis) {
  if (!named.empty()) {
    return knows(model, named) ? std::optional(named) : std::nullopt;
  }
  std::string usual(place.gyro ? "g" : "f");
  usual.append(kAxes[axis]);
  if (knows(model, usual)) {
    return usual;
  }
  const Json channels = model.value("channels", Json::object());
  if (channels.empty()) {
    return std::string();
  }
  return channels.size() == 1 ? std::optional(channels.begin().key()) : std::nullopt;
}

Json plain(const Json& quantity) {
  return Json{{"value", quantity.value("value", Json())}, {"unit", quantity.value("unit", Json())}};
}

/// Processes of the column, its drift as one of them.
Json processes_of(const Json& model, const std::string& column) {
  const Json* const own = member_of(model, "channels", column);
  Json processes = Json::array();
  for (const Json& process : own != nullptr ? own->value("processes", Json::array()) : model.at("processes")) {
    Json params = Json::object();
    for (const auto& [name, value] : process.at("params").items()) {
      params[name] = plain(value);
    }
    processes.push_back(Json{{"process", process.at("process")}, {"params", std::move(params)}});
  }
  const Json* const terms = member_of(model, "deterministic", column);
  if (terms != nullptr && terms->contains("drift")) {
    processes.push_back(Json{{"process", "linear_drift"}, {"params", {{"R", plain(terms->at("drift"))}}}});
  }
  return processes;
}

/// In deg/s or m/s^2.
double bias_of(const Json& model, const std::string& column, const Place& place, const std::string& pointer,
               Faults& faults) {
  const Json* const terms = member_of(model, "deterministic", column);
  if (terms == nullptr || !terms->contains("bias")) {
    return 0.0;
  }
  const Json& bias = terms->at("bias");
  const auto unit = parse_parameter_unit(bias.value("unit", std::string()));
  if (!unit || (place.gyro ? unit->angle : unit->length) != 2) {
    faults.add(pointer, ErrorCode::UnitMismatch, "The bias of channel " + column + " is not one of this sensor.");
    return 0.0;
  }
  return bias.value("value", 0.0) * unit->factor / (place.gyro ? kDegree : 1.0);
}

/// Names of what the scenario cannot hold of the columns in use.
void leave_out(const Json& model, const std::vector<std::string>& columns, bool biased, const Place& place,
               const std::string& id, const std::string& pointer, StoredSensors& found) {
  Json what = Json::array();
  for (const Json& effect : model.value("effects", Json::array())) {
    const Json channels = effect.value("channels", Json::array());
    const bool here = channels.empty() || std::any_of(columns.begin(), columns.end(), [&](const std::string& column) {
                        return column.empty() || std::find(channels.begin(), channels.end(), column) != channels.end();
                      });
    if (here) {
      what.push_back(effect.value("cause", std::string()));
    }
  }
  if (biased && !place.truth) {
    what.push_back("bias");
  }
  if (!what.empty()) {
    constexpr std::string_view kScenario = "/inputs/scenario";
    std::string where = pointer.starts_with(kScenario) ? pointer.substr(kScenario.size()) : pointer;
    found.left_out.push_back(Json{{"where", std::move(where)}, {"simulation_model", id}, {"what", std::move(what)}});
  }
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
  auto stored = store.model(id);
  if (!stored && stored.error().code != ErrorCode::NotFound) {
    return fail(stored.error());
  }
  auto model = stored ? parse_json(stored->document_json) : Result<Json>(Json::object());
  if (!stored || !model || !model->contains("processes")) {
    faults.add(pointer + "/simulation_model", ErrorCode::NotFound, "There is no simulation model " + id + ".");
    return {};
  }
  Json axes = Json::object();
  std::vector<std::string> columns;
  bool biased = false;
  for (std::size_t k = place.axis < 3 ? place.axis : 0; k < (place.axis < 3 ? place.axis + 1 : 3); ++k) {
    const auto column = column_of(*model, named, place, k);
    if (!column) {
      faults.add(pointer + "/channel", named.empty() ? ErrorCode::InvalidArgument : ErrorCode::NotFound,
                 named.empty() ? "The model tells channels apart; name the one that is meant."
                               : "The model has no channel '" + named + "'.");
      return {};
    }
    Json axis{{"processes", processes_of(*model, *column)}};
    if (bias_sd) {
      axis[bias_member] = *bias_sd;
    }
    const double bias = bias_of(*model, *column, place, pointer, faults);
    biased = biased || bias != 0.0;
    if (place.truth && bias != 0.0) {
      Json& list = found.truth_bias[place.gyro ? "gyro_errors" : "accelerometer_errors"];
      list = list.is_null() ? Json{0.0, 0.0, 0.0} : list;
      list[k] = bias;
    }
    columns.push_back(*column);
    axes[kAxes[k]] = std::move(axis);
  }
  leave_out(*model, columns, biased, place, id, pointer, found);
  sensor = place.axis < 3 ? Json(axes[kAxes[place.axis]]) : std::move(axes);
  return {};
}

}  // namespace driftlab::server
