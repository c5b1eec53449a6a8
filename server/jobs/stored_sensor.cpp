#include "server/jobs/stored_sensor.hpp"

#include "core/process/registry.hpp"
#include "core/signal/angle.hpp"
#include "schema/json/simulation_model.hpp"

#include <algorithm>
#include <array>
#include <map>
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

using investigate::Baseline;

bool knows(const Baseline& model, const std::string& column) {
  return model.by_channel.count(column) > 0 || model.bias.count(column) > 0 || model.drift.count(column) > 0;
}

/// The column of one axis; empty where the model does not tell channels apart, nothing where it is not clear.
std::optional<std::string> column_of(const Baseline& model, const std::string& named, const Place& place,
                                     std::size_t axis) {
  if (!named.empty()) {
    return knows(model, named) ? std::optional(named) : std::nullopt;
  }
  std::string usual(place.gyro ? "g" : "f");
  usual.append(kAxes[axis]);
  if (knows(model, usual)) {
    return usual;
  }
  if (model.by_channel.empty()) {
    return std::string();
  }
  return model.by_channel.size() == 1 ? std::optional(model.by_channel.begin()->first) : std::nullopt;
}

double value_of(const std::map<std::string, double>& by_column, const std::string& column) {
  const auto own = by_column.find(column);
  return own == by_column.end() ? 0.0 : own->second;
}

/// Processes of the column with their numbers in SI, its drift as one of them. A fault where they are of another
/// quantity than the sensor's.
Json processes_of(const Baseline& model, const std::string& column, const Place& place, const std::string& pointer,
                  Faults& faults) {
  const auto own = model.by_channel.find(column);
  const bool apart = own != model.by_channel.end();
  const Quantity quantity = apart ? model.quantity_by_channel.at(column) : model.quantity;
  if (quantity != Quantity::Unspecified && quantity != (place.gyro ? Quantity::AngularRate : Quantity::SpecificForce)) {
    faults.add(pointer, ErrorCode::UnitMismatch,
               std::string("The model describes ") + (place.gyro ? "an accelerometer" : "a gyroscope") +
                   ", and this is " + (place.gyro ? "a gyroscope." : "an accelerometer."));
  }
  driftlab::Model all = apart ? own->second : model.processes;
  if (const double drift = value_of(model.drift, column); drift != 0.0) {
    all.push_back({find_process("linear_drift"), {drift}});
  }
  Json processes = Json::array();
  for (const Process& process : all) {
    Json params = Json::object();
    for (std::size_t k = 0; k < process.parameters.size(); ++k) {
      params[std::string(process.kind->parameters[k].name)] = process.parameters[k];
    }
    processes.push_back(Json{{"process", process.kind->name}, {"params", std::move(params)}});
  }
  return processes;
}

/// Names of what the scenario cannot hold of the columns in use.
void leave_out(const Baseline& model, const std::vector<std::string>& columns, bool biased, const Place& place,
               const std::string& id, const std::string& pointer, StoredSensors& found) {
  Json what = Json::array();
  for (const investigate::GivenEffect& effect : model.effects) {
    const std::vector<std::string>& channels = effect.channels;
    const bool here = channels.empty() || std::any_of(columns.begin(), columns.end(), [&](const std::string& column) {
                        return column.empty() || std::find(channels.begin(), channels.end(), column) != channels.end();
                      });
    if (here) {
      what.push_back(effect.cause);
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

/// The stored model `id`; empty after a fault at `pointer` (there is none, or it cannot be read). The error is the
/// store's.
Result<std::optional<Baseline>> stored_model(const std::string& id, Store& store, const std::string& pointer,
                                             Faults& faults) {
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
  Baseline model = simulation_model_from_json(*document, "", within);
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
  const auto& held = *stored;
  if (!held) {
    return {};
  }
  const Baseline& model = *held;
  Json axes = Json::object();
  std::vector<std::string> columns;
  bool biased = false;
  for (std::size_t k = place.axis < 3 ? place.axis : 0; k < (place.axis < 3 ? place.axis + 1 : 3); ++k) {
    const auto column = column_of(model, named, place, k);
    if (!column) {
      faults.add(pointer + "/channel", named.empty() ? ErrorCode::InvalidArgument : ErrorCode::NotFound,
                 named.empty() ? "The model tells channels apart; name the one that is meant."
                               : "The model has no channel '" + named + "'.");
      return {};
    }
    Json axis{{"processes", processes_of(model, *column, place, pointer, faults)}};
    if (bias_sd) {
      axis[bias_member] = *bias_sd;
    }
    const double bias = value_of(model.bias, *column) / (place.gyro ? kDegree : 1.0);  // [deg/s] or [m/s^2]
    biased = biased || bias != 0.0;
    if (place.truth && bias != 0.0) {
      Json& list = found.truth_bias[place.gyro ? "gyro_errors" : "accelerometer_errors"];
      list = list.is_null() ? Json{0.0, 0.0, 0.0} : list;
      list[k] = bias;
    }
    columns.push_back(*column);
    axes[kAxes[k]] = std::move(axis);
  }
  leave_out(model, columns, biased, place, id, pointer, found);
  sensor = place.axis < 3 ? Json(axes[kAxes[place.axis]]) : std::move(axes);
  return {};
}

}  // namespace driftlab::server
