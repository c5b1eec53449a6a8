#include "core/analysis/modelled_sensor.hpp"

#include "core/process/registry.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <optional>

namespace driftlab {
namespace {

using investigate::Baseline;

bool knows(const Baseline& model, const std::string& column) {
  return model.by_channel.contains(column) || model.bias.contains(column) || model.drift.contains(column);
}

/// The column of one axis; empty where the model does not tell columns apart, nothing where it is not clear.
std::optional<std::string> column_of(const Baseline& model, const ScenarioSensor& sensor, std::size_t axis) {
  if (!sensor.column.empty()) {
    return knows(model, sensor.column) ? std::optional(sensor.column) : std::nullopt;
  }
  static constexpr std::array kAxes{"x", "y", "z"};
  std::string usual(sensor.gyro ? "g" : "f");
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

/// The processes of the column, its drift as one of them.
Result<Model> processes_of(const Baseline& model, const std::string& column, bool gyro) {
  const auto own = model.by_channel.find(column);
  const bool apart = own != model.by_channel.end();
  const Quantity quantity = apart ? model.quantity_by_channel.at(column) : model.quantity;
  if (quantity != Quantity::Unspecified && quantity != (gyro ? Quantity::AngularRate : Quantity::SpecificForce)) {
    return fail(ErrorCode::UnitMismatch, std::string("The model describes ") +
                                             (gyro ? "an accelerometer" : "a gyroscope") + ", and this is " +
                                             (gyro ? "a gyroscope." : "an accelerometer."));
  }
  Model all = apart ? own->second : model.processes;
  if (const double drift = value_of(model.drift, column); drift != 0.0) {
    all.push_back({find_process("linear_drift"), {drift}});
  }
  return all;
}

/// Causes of the effects on columns in use; the empty column stands for all of them.
std::vector<std::string> effects_on(const Baseline& model, const std::vector<std::string>& columns) {
  std::vector<std::string> causes;
  for (const investigate::GivenEffect& effect : model.effects) {
    const std::vector<std::string>& channels = effect.channels;
    const bool here = channels.empty() || std::any_of(columns.begin(), columns.end(), [&](const std::string& column) {
                        return column.empty() || std::find(channels.begin(), channels.end(), column) != channels.end();
                      });
    if (here) {
      causes.push_back(effect.cause);
    }
  }
  return causes;
}

}  // namespace

Result<ModelledSensor> sensor_of_model(const Baseline& model, const ScenarioSensor& sensor) {
  ModelledSensor made;
  std::vector<std::string> columns;
  bool biased = false;
  for (const std::size_t axis : sensor.axes) {
    const auto column = column_of(model, sensor, axis);
    if (!column && sensor.column.empty()) {
      return fail(ErrorCode::InvalidArgument, "The model tells channels apart; name the one that is meant.",
                  {{"parameter", "channel"}});
    }
    if (!column) {
      return fail(ErrorCode::NotFound, "The model has no channel '" + sensor.column + "'.", {{"parameter", "channel"}});
    }
    auto processes = processes_of(model, *column, sensor.gyro);
    if (!processes) {
      return fail(processes.error());
    }
    const double bias = value_of(model.bias, *column);
    biased = biased || bias != 0.0;
    made.axes.push_back({axis, std::move(*processes), bias});
    columns.push_back(*column);
  }
  made.left_out = effects_on(model, columns);
  if (biased && !sensor.truth) {
    made.left_out.emplace_back("bias");
  }
  return made;
}

}  // namespace driftlab
