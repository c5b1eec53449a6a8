#include "schema/json/investigation.hpp"

#include "core/investigate/causes/cause.hpp"
#include "core/process/registry.hpp"
#include "schema/json/parameter_unit.hpp"

#include <cmath>

namespace driftlab {
namespace {

using investigate::Baseline;
using investigate::ChannelModel;
using investigate::Check;
using investigate::Evidence;
using investigate::Finding;
using investigate::GivenProcess;
using investigate::Report;
using investigate::SlowComponent;
using investigate::SlowKind;

/// One parameter of a given process, its unit checked against the process and the quantity it implies.
double read_parameter(const Json& document, const ParameterSpec& spec, const std::string& pointer, Quantity& quantity,
                      Faults& faults) {
  ObjectReader reader(document, pointer, faults);
  const double value = reader.real("value").value_or(0.0);
  const std::string symbol = reader.required_text("unit");
  reader.reject_unknown();
  auto unit = parse_parameter_unit(symbol);
  if (!unit) {
    faults.add(pointer + "/unit", unit.error());
    return 0.0;
  }
  const bool gyro = unit->angle == 2;
  const bool accelerometer = unit->length == 2;
  const int second = unit->second + (spec.channel_power == 0 ? 0 : gyro ? 2 : accelerometer ? 4 : 0);
  if (second != spec.second_power_halves || (spec.channel_power == 0 && (unit->angle != 0 || unit->length != 0))) {
    faults.add(pointer + "/unit", ErrorCode::UnitMismatch,
               "The unit " + symbol + " does not measure the parameter " + std::string(spec.name) + ".");
  }
  if (spec.channel_power == 1) {
    quantity = gyro ? Quantity::AngularRate : accelerometer ? Quantity::SpecificForce : Quantity::Unspecified;
  }
  if (!(value >= 0.0) && spec.lower >= 0.0) {
    faults.add(pointer + "/value", ErrorCode::InvalidArgument, "A level or rate of a process is not negative.");
  }
  return value * unit->factor;
}

void read_process(const Json& document, const std::string& pointer, Baseline& baseline, Faults& faults) {
  ObjectReader reader(document, pointer, faults);
  const std::string name = reader.required_text("process");
  const Json* const params = reader.member("params");
  reader.reject_unknown();
  const ProcessKind* const kind = find_process(name);
  if (kind == nullptr || params == nullptr || !params->is_object()) {
    faults.add(pointer + "/process", ErrorCode::InvalidArgument, "There is no process called '" + name + "'.");
    return;
  }
  GivenProcess process{std::string(kind->name), {}};
  ObjectReader values(*params, pointer + "/params", faults);
  for (const ParameterSpec& spec : kind->parameters) {
    const Json* const value = values.member(spec.name);
    if (value == nullptr) {
      faults.add(pointer + "/params", ErrorCode::InvalidArgument,
                 "The parameter " + std::string(spec.name) + " of " + name + " is missing.");
      return;
    }
    process.parameters.push_back(
        read_parameter(*value, spec, pointer + "/params/" + std::string(spec.name), baseline.quantity, faults));
  }
  baseline.processes.push_back(std::move(process));
}

Json parameter_json(double value, double per_si, const std::string& unit) {
  return Json{{"value", number(value * per_si)}, {"unit", unit}};
}

Json processes_json(const ChannelModel& model) {
  const Dimension dimension = model.unit.dimension;
  const auto lab = [&](int halves) { return lab_unit(dimension, halves); };
  Json list = Json::array();
  const ParameterUnit n = lab(1);
  list.push_back({{"process", "white_noise"},
                  {"params", {{"N", parameter_json(std::sqrt(model.base.white), n.per_si, n.symbol)}}}});
  for (const SlowComponent& component : model.base.components) {
    const double level = std::sqrt(component.level);
    switch (component.kind) {
      case SlowKind::GaussMarkov:
        list.push_back({{"process", "gauss_markov"},
                        {"params",
                         {{"sigma", parameter_json(level, lab(0).per_si, lab(0).symbol)},
                          {"beta", parameter_json(component.beta, 1.0, "1/s")}}}});
        break;
      case SlowKind::RandomWalk:
        list.push_back(
            {{"process", "random_walk"}, {"params", {{"K", parameter_json(level, lab(-1).per_si, lab(-1).symbol)}}}});
        break;
      case SlowKind::Flicker:
        list.push_back(
            {{"process", "flicker_noise"}, {"params", {{"B", parameter_json(level, lab(0).per_si, lab(0).symbol)}}}});
        break;
      case SlowKind::Offset:
        break;
    }
  }
  return list;
}

Json model_json(const Report& report) {
  Json document{{"processes", Json::array()}, {"deterministic", Json::object()}};
  if (report.models.empty()) {
    return document;
  }
  document["processes"] = processes_json(report.models.front());
  Json channels = Json::object();
  for (const ChannelModel& model : report.models) {
    const investigate::LabUnit unit = investigate::level_unit(model.unit);
    const Json bias = parameter_json(model.bias, unit.per_si, unit.symbol);
    document["deterministic"][model.channel] = Json{{"bias", bias}};
    if (model.drift != 0.0) {
      const investigate::LabUnit slope = investigate::level_unit(model.unit, "/s");
      document["deterministic"][model.channel]["drift"] = parameter_json(model.drift, slope.per_si, slope.symbol);
    }
    channels[model.channel] = Json{{"processes", processes_json(model)}};
  }
  document["channels"] = std::move(channels);
  return document;
}

Json check_json(const Check& check) {
  return Json{
      {"id", check.id},
      {"recording", check.recording.empty() ? Json(nullptr) : Json(check.recording)},
      {"channel", check.channel},
      {"observed", number(check.observed)},
      {"simulated", {{"q025", number(check.q025)}, {"median", number(check.median)}, {"q975", number(check.q975)}}},
      {"p", number(check.p)},
      {"p_adjusted", number(check.p_adjusted)},
      {"failed", check.failed}};
}

Json parameters_json(const Evidence& evidence) {
  Json parameters = Json::object();
  for (const auto& parameter : evidence.parameters) {
    parameters[parameter.name] = quantity(parameter.estimate, parameter.unit.per_si, parameter.unit.symbol);
  }
  return parameters;
}

Json finding_json(const Finding& finding) {
  Json alternatives = Json::array();
  for (const Evidence& rival : finding.evidence.rivals) {
    alternatives.push_back(std::string(rival.cause->name));
  }
  Json next = finding.next_measurement.empty() ? Json(nullptr) : Json(finding.next_measurement);
  return Json{{"cause", std::string(finding.evidence.cause->name)},
              {"status", finding.evidence.ambiguous ? "ambiguous" : "identified"},
              {"alternatives", std::move(alternatives)},
              {"channels", finding.channels},
              {"because", finding.because},
              {"explanation", finding.explanation},
              {"parameters", parameters_json(finding.evidence)},
              {"score", number(finding.evidence.score)},
              {"gain",
               {{"log_score_per_sample", number(finding.gain.log_score_per_sample)},
                {"misfit_before", number(finding.gain.misfit_before)},
                {"misfit_after", number(finding.gain.misfit_after)},
                {"heldout", finding.gain.heldout},
                {"heldout_share", number(finding.gain.share)},
                {"heldout_samples", number(finding.gain.samples)}}},
              {"next_measurement", std::move(next)}};
}

}  // namespace

Baseline baseline_from_json(const Json& document, const std::string& pointer, Faults& faults) {
  Baseline baseline;
  ObjectReader reader(document, pointer, faults);
  const std::string kind = reader.required_text("kind");
  const Json* const processes = reader.member("processes");
  const Json* const channels = reader.member("channels");
  (void)reader.member("id");
  (void)reader.member("effects");
  (void)reader.member("deterministic");
  reader.reject_unknown();
  if (kind == "auto") {
    return baseline;
  }
  if (kind != "model" || processes == nullptr || !processes->is_array() || processes->empty()) {
    faults.add(pointer + "/kind", ErrorCode::InvalidArgument,
               kind == "fit" ? "A stored fit as baseline needs the daemon that stores it."
                             : "A baseline is \"auto\" or a \"model\" with at least one process.");
    return baseline;
  }
  baseline.automatic = false;
  for (std::size_t i = 0; i < processes->size(); ++i) {
    read_process((*processes)[i], pointer + "/processes/" + std::to_string(i), baseline, faults);
  }
  if (channels != nullptr && channels->is_array()) {
    for (const Json& channel : *channels) {
      if (channel.is_string()) {
        baseline.channels.push_back(channel.get<std::string>());
      }
    }
  }
  return baseline;
}

Json to_json(const Report& report) {
  Json checks = Json::array();
  for (const Check& check : report.checks) {
    checks.push_back(check_json(check));
  }
  Json findings = Json::array();
  Json effects = Json::array();
  for (const Finding& finding : report.findings) {
    findings.push_back(finding_json(finding));
    Json columns = Json::array();
    for (const std::string& channel : finding.channels) {
      const std::string column = channel.substr(channel.find('/') + 1);
      if (std::find(columns.begin(), columns.end(), column) == columns.end()) {
        columns.push_back(column);
      }
    }
    effects.push_back({{"cause", std::string(finding.evidence.cause->name)},
                       {"channels", std::move(columns)},
                       {"params", parameters_json(finding.evidence)}});
  }
  Json extended = model_json(report);
  extended["effects"] = std::move(effects);
  Json unexplained = Json::array();
  for (const auto& left : report.unexplained) {
    unexplained.push_back({{"channel", left.channel}, {"explanation", left.sentence}, {"checks", left.checks}});
  }
  Json not_examined = Json::array();
  for (const auto& item : report.not_examined) {
    not_examined.push_back({{"cause", item.cause}, {"channel", item.channel}, {"needs", item.needs}});
  }
  return Json{{"study", report.study},
              {"baseline", model_json(report)},
              {"checks", std::move(checks)},
              {"findings", std::move(findings)},
              {"extended_model", std::move(extended)},
              {"gain",
               {{"misfit_before", number(report.misfit_before)},
                {"misfit_after", number(report.misfit_after)},
                {"checks_failed_before", report.failed_before},
                {"checks_failed_after", report.failed_after},
                {"outage_error_m", {{"baseline", nullptr}, {"extended", nullptr}, {"measured", nullptr}}}}},
              {"unexplained", std::move(unexplained)},
              {"not_examined", std::move(not_examined)},
              {"notes", report.notes}};
}

}  // namespace driftlab
