#include "schema/json/reported_channel.hpp"

#include "schema/json/stored_member.hpp"

#include <limits>

namespace driftlab {
namespace {

constexpr double kNotKnown = std::numeric_limits<double>::quiet_NaN();

std::optional<double> optional_number(const Json& value) {
  return value.is_number() ? std::optional<double>(value.get<double>()) : std::nullopt;
}

Json optional_number(const std::optional<double>& value) { return value ? number(*value) : Json(nullptr); }

ReportedValue value_from_json(const Json& parameter, const Json& reasons, const std::string& name) {
  ReportedValue value;
  if (parameter.is_object()) {
    value.value = optional_number(parameter.at("value"));
    value.unit = parameter.at("unit").get<std::string>();
    value.low = optional_number(parameter.at("ci95").at(0));
    value.high = optional_number(parameter.at("ci95").at(1));
  } else if (reasons.is_object()) {
    value.reason = reasons.value(name, "");
  }
  return value;
}

ReportedProcess process_from_json(const Json& document) {
  ReportedProcess process{document.at("process").get<std::string>(), {}};
  const Json reasons = document.value("reasons", Json());
  for (const auto& [name, parameter] : document.at("params").items()) {
    process.parameters.emplace_back(name, value_from_json(parameter, reasons, name));
  }
  return process;
}

Json process_to_json(const ReportedProcess& process) {
  Json reasons = Json::object();
  Json document{{"process", process.process}, {"params", to_json(process.parameters, reasons)}};
  if (!reasons.empty()) {
    document["reasons"] = std::move(reasons);
  }
  return document;
}

std::vector<std::string> texts(const Json& document, const char* name) {
  const auto found = document.find(name);
  return found == document.end() ? std::vector<std::string>{} : found->get<std::vector<std::string>>();
}

ReportedFit fit_from_json(const Json& document) {
  ReportedFit fit;
  fit.model = document.at("model").get<std::string>();
  fit.robust = document.value("robust", false);
  fit.processes = processes_from_json(document.at("processes"));
  fit.objective = finite_member(document, "objective", kNotKnown);
  fit.wic = finite_member(document, "wic", kNotKnown);
  fit.equation_8 = finite_member(document, "equation_8", kNotKnown);
  fit.optimism = finite_member(document, "optimism", kNotKnown);
  fit.condition_number = finite_member(document, "condition_number", kNotKnown);
  fit.bounds_active = texts(document, "bounds_active");
  fit.intervals = text_member(document, "intervals");
  fit.plausible = document.value("plausible", false);
  if (const auto test = document.find("j_test"); test != document.end() && test->is_object()) {
    fit.j_test = JTest{finite_member(*test, "statistic", kNotKnown), finite_member(*test, "dof", kNotKnown),
                       finite_member(*test, "p", kNotKnown)};
  }
  fit.verdict = text_member(document, "verdict");
  fit.described_within = finite_member(document, "described_within", 0.0);
  fit.status = text_member(document, "status");
  fit.warnings = texts(document, "warnings");
  return fit;
}

/// Numbers of a list with `otherwise` for each null; nothing where there is no list.
std::vector<double> numbers(const Json& document, const char* name, double otherwise) {
  std::vector<double> values;
  if (const auto found = document.find(name); found != document.end() && found->is_array()) {
    for (const Json& value : *found) {
      values.push_back(value.is_number() ? value.get<double>() : otherwise);
    }
  }
  return values;
}

ReportedHaar haar_from_json(const Json& document) {
  ReportedHaar haar;
  haar.scale = document.at("scale").get<std::vector<std::size_t>>();
  haar.variance = numbers(document, "variance", 0.0);
  haar.efficiency = numbers(document, "efficiency_by_scale", 1.0);
  if (const auto robust = document.find("robust"); robust != document.end() && robust->is_object()) {
    haar.robust_variance = numbers(*robust, "variance", 0.0);
    haar.robust_efficiency = numbers(*robust, "efficiency_by_scale", 1.0);
  }
  return haar;
}

ReportedChannel channel_from_json(const Json& document) {
  ReportedChannel channel;
  channel.channel = text_member(document, "channel");
  channel.quantity = text_member(document, "quantity");
  channel.axis = text_member(document, "axis");
  channel.unit = text_member(document, "unit");
  channel.samples = document.at("samples").get<std::size_t>();
  channel.missing = document.value("missing", std::size_t{0});
  channel.dt_s = document.at("dt_s").get<double>();
  channel.haar = haar_from_json(document.at("haar"));
  if (const auto allan = document.find("allan"); allan != document.end() && allan->is_object()) {
    channel.haar.edf = numbers(*allan, "edf", 0.0);  // of the same octaves
  }
  if (const auto found = document.find("contamination"); found != document.end() && found->is_object()) {
    channel.contamination = text_member(*found, "verdict");
  }
  channel.from_tau_s = finite_member(document, "from_tau_s", 0.0);
  channel.discrepancy = finite_member(document, "discrepancy", 0.0);
  const Json& allan = document.at("allan_parameters");
  const Json reasons = allan.value("reasons", Json());
  for (const auto& [name, parameter] : allan.items()) {
    if (name != "reasons") {
      channel.allan.emplace_back(name, value_from_json(parameter, reasons, name));
    }
  }
  channel.fits = fits_from_json(document.at("fits"));
  if (const auto found = document.find("description"); found != document.end() && found->is_object()) {
    channel.description = text_member(*found, "sentence");
  }
  return channel;
}

}  // namespace

std::optional<Contamination> contamination_from_json(const Json& channel) {
  const auto found = channel.find("contamination");
  if (found == channel.end() || !found->is_object()) {
    return std::nullopt;
  }
  Contamination contamination;
  contamination.verdict = text_member(*found, "verdict");
  contamination.p = finite_member(*found, "p", 1.0);
  for (const Json& scale : found->value("disjoint_scales", Json::array())) {
    contamination.disjoint_scales.push_back(scale.is_number_unsigned() ? scale.get<std::size_t>() : 0);
  }
  contamination.flagged_samples = count_member(*found, "flagged_samples");
  if (found->contains("bursts")) {
    contamination.bursts = count_member(*found, "bursts");
  }
  contamination.not_gaussian = found->value("not_gaussian", false);
  return contamination;
}

Json to_json(const ReportedValue& value) {
  if (!value.value) {
    return nullptr;
  }
  return Json{{"value", number(*value.value)},
              {"unit", value.unit},
              {"ci95", Json::array({optional_number(value.low), optional_number(value.high)})}};
}

ReportedValue reported_value_from_json(const Json& document) { return value_from_json(document, nullptr, ""); }

Json to_json(const ReportedValues& values, Json& reasons) {
  Json document = Json::object();
  for (const auto& [name, value] : values) {
    if (!value.value) {
      document[name] = nullptr;
      reasons[name] = value.reason;
      continue;
    }
    document[name] = to_json(value);
  }
  return document;
}

Json to_json(const ReportedFit& fit) {
  Json processes = Json::array();
  for (const ReportedProcess& process : fit.processes) {
    processes.push_back(process_to_json(process));
  }
  return Json{{"model", fit.model},
              {"robust", fit.robust},
              {"processes", std::move(processes)},
              {"objective", number(fit.objective)},
              {"wic", number(fit.wic)},
              {"equation_8", number(fit.equation_8)},
              {"optimism", number(fit.optimism)},
              {"condition_number", number(fit.condition_number)},
              {"bounds_active", fit.bounds_active},
              {"intervals", fit.intervals},
              {"plausible", fit.plausible},
              {"j_test", fit.j_test ? Json{{"statistic", number(fit.j_test->statistic)},
                                           {"dof", number(fit.j_test->dof)},
                                           {"p", number(fit.j_test->p)}}
                                    : Json(nullptr)},
              {"verdict", text_or_null(fit.verdict)},
              {"described_within", number(fit.described_within)},
              {"status", fit.status},
              {"warnings", fit.warnings}};
}

std::vector<ReportedFit> fits_from_json(const Json& fits) {
  std::vector<ReportedFit> read;
  for (const Json& fit : fits) {
    read.push_back(fit_from_json(fit));
  }
  return read;
}

std::vector<ReportedProcess> processes_from_json(const Json& processes) {
  std::vector<ReportedProcess> read;
  for (const Json& process : processes) {
    read.push_back(process_from_json(process));
  }
  return read;
}

Result<StoredFit> stored_fit_from_json(const Json& document) {
  try {
    StoredFit stored{fit_from_json(document), std::nullopt};
    if (const auto density = document.find("density"); density != document.end()) {
      stored.density = reported_value_from_json(*density);
    }
    return stored;
  } catch (const Json::exception& fault) {
    return fail(ErrorCode::Internal, "A stored fit cannot be read: " + std::string(fault.what()) + ".");
  }
}

Result<ReportedChannel> reported_channel_from_json(const Json& document) {
  try {
    return channel_from_json(document);
  } catch (const Json::exception& fault) {
    return fail(ErrorCode::Internal, "A stored channel cannot be read: " + std::string(fault.what()) + ".");
  }
}

}  // namespace driftlab
