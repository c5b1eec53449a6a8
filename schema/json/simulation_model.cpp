#include "schema/json/simulation_model.hpp"

#include "core/investigate/causes/cause.hpp"
#include "core/investigate/search/given_model.hpp"
#include "core/process/parameter_unit.hpp"
#include "schema/json/error_model.hpp"
#include "schema/json/unnamed_effect.hpp"

#include <algorithm>

namespace driftlab {
namespace {

using investigate::Baseline;
using investigate::Cause;
using investigate::CauseParameter;
using investigate::ChannelBase;
using investigate::ChannelModel;
using investigate::Finding;
using investigate::GivenEffect;
using investigate::Report;

/// A number with its unit; an interval beside it (a stored estimate has one) is let be.
struct Measured {
  double value = 0.0;
  std::string unit;
};

Measured read_measured(const Json& document, const std::string& pointer, Faults& faults) {
  ObjectReader reader(document, pointer, faults);
  Measured measured{reader.real("value").value_or(0.0), reader.required_text("unit")};
  (void)reader.member("ci95");
  reader.reject_unknown();
  return measured;
}

Quantity quantity_of(Dimension channel) {
  return channel == Dimension::AngularRate     ? Quantity::AngularRate
         : channel == Dimension::SpecificForce ? Quantity::SpecificForce
                                               : Quantity::Unspecified;
}

/// Columns that have processes of their own.
void read_channels(const Json& channels, const std::string& pointer, Baseline& model, Faults& faults) {
  for (const auto& [column, own] : channels.items()) {
    std::string here = pointer;
    here.append("/").append(column);
    ObjectReader reader(own, here, faults);
    const Json* const processes = reader.member("processes");
    reader.reject_unknown();
    std::optional<Dimension> channel;
    model.by_channel[column] =
        model_from_json(processes != nullptr ? *processes : Json(), channel, here + "/processes", faults);
    model.quantity_by_channel[column] = quantity_of(channel.value_or(Dimension::AngularRate));
  }
}

/// The SI value of a cause's parameter: in the unit in which reports write it for one kind of sensor or another, or in
/// any that converts to it.
std::optional<double> cause_value(const Measured& measured, const CauseParameter& parameter) {
  for (const char* const sensor : {"rad/s", "m/s^2", "1"}) {
    const investigate::LabUnit unit = parameter.unit(*parse_unit(sensor));
    if (unit.symbol == measured.unit) {
      return measured.value / unit.per_si;
    }
    const auto expected = parse_parameter_unit(unit.symbol);
    const auto said = parse_parameter_unit(measured.unit);
    if (expected && said && expected->angle == said->angle && expected->length == said->length &&
        expected->second == said->second) {
      return measured.value * said->factor;
    }
  }
  return std::nullopt;
}

std::vector<std::string> texts(const Json* list) {
  std::vector<std::string> names;
  if (list != nullptr && list->is_array()) {
    for (const Json& name : *list) {
      if (name.is_string()) {
        names.push_back(name.get<std::string>());
      }
    }
  }
  return names;
}

/// One value per parameter of the cause, in declared order; where each shape of a mean effect has a parameter of its
/// own, the first one there is, and its shape. Nothing where one is missing or does not fit.
std::optional<std::vector<double>> read_effect_values(const Json& params, const Cause& cause,
                                                      const std::string& pointer, Faults& faults) {
  const auto* const mean = cause.as<investigate::MeanEffect>();
  const bool one_of_them = mean != nullptr && !mean->shape_of_parameter.empty();
  std::vector<double> values;
  for (std::size_t k = 0; k < cause.parameters.size(); ++k) {
    const CauseParameter& parameter = cause.parameters[k];
    const std::string name(parameter.name);
    std::string here = pointer;
    here.append("/").append(name);
    const auto found = params.find(name);
    if (found == params.end()) {
      if (one_of_them && k + 1 < cause.parameters.size()) {
        continue;
      }
      faults.add(here, ErrorCode::InvalidArgument,
                 "The parameter " + name + " of " + std::string(cause.name) + " is missing.");
      return std::nullopt;
    }
    const std::optional<double> value = cause_value(read_measured(*found, here, faults), parameter);
    if (!value) {
      faults.add(here + "/unit", ErrorCode::UnitMismatch,
                 "This unit does not measure " + name + " of " + std::string(cause.name) + ".");
      return std::nullopt;
    }
    if (one_of_them) {
      return std::vector{*value, mean->shape_of_parameter[k]};
    }
    values.push_back(*value);
  }
  return values;
}

void read_effect(const Json& document, const std::string& pointer, Baseline& model, Faults& faults) {
  ObjectReader reader(document, pointer, faults);
  GivenEffect effect;
  effect.cause = reader.required_text("cause");
  effect.channels = texts(reader.member("channels"));
  effect.recordings = texts(reader.member("recordings"));
  const Json* const params = reader.member("params");
  reader.reject_unknown();
  const Cause* const cause = investigate::find_cause(effect.cause);
  if (cause == nullptr || params == nullptr || !params->is_object()) {
    faults.add(pointer + "/cause", ErrorCode::InvalidArgument,
               "An effect names a cause, and there is none called '" + effect.cause + "'.");
    return;
  }
  auto values = read_effect_values(*params, *cause, pointer + "/params", faults);
  if (values) {
    effect.values = *std::move(values);
    model.effects.push_back(std::move(effect));
  }
}

void read_deterministic(const Json& document, const std::string& pointer, Baseline& model, Faults& faults) {
  for (const auto& [column, terms] : document.items()) {
    for (const char* const name : {"bias", "drift"}) {
      if (!terms.is_object() || !terms.contains(name)) {
        continue;
      }
      std::string here = pointer;
      here.append("/").append(column).append("/").append(name);
      const Measured measured = read_measured(terms[name], here, faults);
      auto unit = parse_parameter_unit(measured.unit);
      if (!unit) {
        faults.add(here + "/unit", unit.error());
        continue;
      }
      const bool bias = name == std::string_view("bias");
      const auto own = model.quantity_by_channel.find(column);
      const Quantity quantity = own == model.quantity_by_channel.end() ? model.quantity : own->second;
      if (!measures(*unit, quantity, bias ? 0 : 1)) {
        faults.add(here + "/unit", ErrorCode::UnitMismatch,
                   "This unit does not measure the " + std::string(name) + " of channel " + column + ".");
        continue;
      }
      (bias ? model.bias : model.drift)[column] = measured.value * unit->factor;
    }
  }
}

Json value_json(double si, double per_si, const std::string& unit) {
  return Json{{"value", number(si * per_si)}, {"unit", unit}};
}

/// The effects of a given baseline, in the units of their channels.
Json given_effects_json(const Baseline& baseline, const Unit& channel) {
  Json list = Json::array();
  for (const GivenEffect& effect : baseline.effects) {
    const Cause& cause = *investigate::find_cause(effect.cause);
    Json params = Json::object();
    const auto* const mean = cause.as<investigate::MeanEffect>();
    const bool by_shape = mean != nullptr && !mean->shape_of_parameter.empty() && effect.values.size() > 1;
    const std::size_t most = by_shape ? 1 : cause.parameters.size();
    for (std::size_t k = 0; k < most && k < effect.values.size(); ++k) {
      const CauseParameter& parameter = by_shape ? amplitude_of(cause, effect.values[1]) : cause.parameters[k];
      const investigate::LabUnit unit = parameter.unit(channel);
      params[std::string(parameter.name)] = value_json(effect.values[k], unit.per_si, unit.symbol);
    }
    Json item{{"cause", effect.cause}, {"channels", effect.channels}, {"params", std::move(params)}};
    if (!effect.recordings.empty()) {
      item["recordings"] = effect.recordings;
    }
    list.push_back(std::move(item));
  }
  return list;
}

/// Appends the profile of a channel to `document`.
void append_unnamed(const investigate::UnnamedEffect& effect, const Report& report, Json& document) {
  for (const ChannelModel& model : report.models) {
    if (model.channel == effect.column) {
      document["unnamed"].push_back(to_json(effect, model.unit));
    }
  }
}

Json found_effect_json(const Finding& finding) {
  std::vector<std::string> columns;
  std::vector<std::string> recordings;
  const auto add = [](std::vector<std::string>& list, const std::string& name) {
    if (std::find(list.begin(), list.end(), name) == list.end()) {
      list.push_back(name);
    }
  };
  for (const auto& [recording, column] : finding.channels) {
    add(recordings, recording);
    add(columns, column);
  }
  Json item{{"cause", std::string(finding.evidence.cause->name)},
            {"channels", std::move(columns)},
            {"params", parameters_json(finding.evidence)}};
  if (!finding.everywhere) {
    item["recordings"] = std::move(recordings);
  }
  return item;
}

}  // namespace

Json parameters_json(const investigate::Evidence& evidence) {
  Json parameters = Json::object();
  for (const auto& parameter : evidence.parameters) {
    parameters[parameter.name] = quantity(parameter.estimate, parameter.unit.per_si, parameter.unit.symbol);
  }
  return parameters;
}

Baseline simulation_model_from_json(const Json& document, const std::string& pointer, Faults& faults) {
  Baseline model;
  model.automatic = false;
  ObjectReader reader(document, pointer, faults);
  const Json* const processes = reader.member("processes");
  const Json* const channels = reader.member("channels");
  const Json* const deterministic = reader.member("deterministic");
  const Json* const effects = reader.member("effects");
  const Json* const unnamed = reader.member("unnamed");
  if (processes == nullptr || !processes->is_array() || processes->empty()) {
    faults.add(pointer + "/processes", ErrorCode::InvalidArgument, "A model has at least one process.");
    return model;
  }
  std::optional<Dimension> channel;
  model.processes = model_from_json(*processes, channel, pointer + "/processes", faults);
  model.quantity = quantity_of(channel.value_or(Dimension::AngularRate));
  if (channels != nullptr && channels->is_object()) {
    read_channels(*channels, pointer + "/channels", model, faults);
  } else {
    model.channels = texts(channels);
  }
  if (deterministic != nullptr && deterministic->is_object()) {
    read_deterministic(*deterministic, pointer + "/deterministic", model, faults);
  }
  for (std::size_t i = 0; effects != nullptr && effects->is_array() && i < effects->size(); ++i) {
    read_effect((*effects)[i], pointer + "/effects/" + std::to_string(i), model, faults);
  }
  for (std::size_t i = 0; unnamed != nullptr && unnamed->is_array() && i < unnamed->size(); ++i) {
    read_unnamed_effect((*unnamed)[i], pointer + "/unnamed/" + std::to_string(i), model, faults);
  }
  return model;
}

Baseline baseline_from_json(const Json& document, const std::string& pointer, Faults& faults) {
  ObjectReader reader(document, pointer, faults);
  const std::string kind = reader.required_text("kind");
  const bool stored = reader.member("id") != nullptr;
  for (const char* const name : {"processes", "channels", "deterministic", "effects", "unnamed"}) {
    (void)reader.member(name);
  }
  reader.reject_unknown();
  if (kind == "auto") {
    return {};
  }
  if (kind == "fit" || stored) {
    faults.add(pointer + "/kind", ErrorCode::InvalidArgument,
               "A stored fit or model as baseline needs the daemon that stores it.");
    return {};
  }
  if (kind != "model") {
    faults.add(pointer + "/kind", ErrorCode::InvalidArgument, "A baseline is \"auto\", a \"model\" or a \"fit\".");
    return {};
  }
  return simulation_model_from_json(document, pointer, faults);
}

namespace {

/// The members of a model, from the base of each channel that `base` points to.
Json bases_json(const Report& report, ChannelBase ChannelModel::* base) {
  Json document{{"processes", Json::array()}, {"deterministic", Json::object()}};
  if (report.models.empty()) {
    return document;
  }
  Json channels = Json::object();
  for (const ChannelModel& model : report.models) {
    const Dimension dimension = model.unit.dimension;
    const Json processes = to_json(noise_processes(model, model.*base), dimension);
    if (channels.empty()) {
      document["processes"] = processes;
    }
    const investigate::LabUnit unit = investigate::level_unit(model.unit);
    document["deterministic"][model.channel] = Json{{"bias", value_json((model.*base).bias, unit.per_si, unit.symbol)}};
    if ((model.*base).drift != 0.0) {
      const investigate::LabUnit slope = investigate::level_unit(model.unit, "/s");
      document["deterministic"][model.channel]["drift"] = value_json((model.*base).drift, slope.per_si, slope.symbol);
    }
    channels[model.channel] = Json{{"processes", processes}};
  }
  document["channels"] = std::move(channels);
  if (!report.baseline.effects.empty()) {
    document["effects"] = given_effects_json(report.baseline, report.models.front().unit);
  }
  for (const investigate::UnnamedEffect& effect : report.baseline.unnamed) {
    append_unnamed(effect, report, document);
  }
  return document;
}

}  // namespace

Json baseline_json(const Report& report) { return bases_json(report, &ChannelModel::alone); }

Json extended_json(const Report& report) {
  Json document = bases_json(report, &ChannelModel::beside);
  Json effects = document.value("effects", Json::array());
  for (const Finding& finding : report.findings) {
    effects.push_back(found_effect_json(finding));
  }
  document["effects"] = std::move(effects);
  for (const investigate::UnnamedFinding& found : report.unnamed) {
    append_unnamed(found.effect, report, document);
  }
  return document;
}

}  // namespace driftlab
