#include "schema/json/channel_summary.hpp"

#include "core/campaign/absent_process.hpp"
#include "schema/json/error_model.hpp"
#include "schema/json/figure_values.hpp"
#include "schema/json/reported_channel.hpp"

#include <utility>
#include <vector>

namespace driftlab {
namespace {

template <class Value>
Json listed(const std::vector<Value>& values) {
  Json list = Json::array();
  for (const std::optional<double> value : values) {
    list.push_back(value ? number(*value) : Json(nullptr));
  }
  return list;
}

/// The processes of a fit without those that it has nothing of.
Json present(const Json& processes) {
  Json kept = Json::array();
  const std::vector<ReportedProcess> told = processes_from_json(processes);
  for (std::size_t i = 0; i < told.size(); ++i) {
    if (!none_found(told[i])) {
      kept.push_back(processes[i]);
    }
  }
  return kept;
}

Json to_json(const MeasuredOverModel& at_measured) {
  Json ci95 = Json::array();
  for (std::size_t i = 0; i < at_measured.ratio.size(); ++i) {
    ci95.push_back(listed(std::vector{at_measured.low[i], at_measured.high[i]}));
  }
  return Json{{"tau_s", listed(at_measured.tau_s)},
              {"deviation", listed(at_measured.deviation)},
              {"measured_over_model", listed(at_measured.ratio)},
              {"ci95", std::move(ci95)}};
}

Json to_json(const ImpliedBeside& implied, const Unit& unit) {
  Json deviations = Json::array();
  Json densities = Json::array();
  for (const ImpliedComponent& component : implied.curves.components) {
    deviations.push_back(Json{{"process", component.process}, {"deviation", listed(component.deviation)}});
    densities.push_back(Json{{"process", component.process}, {"density", listed(component.density)}});
  }
  return Json{{"unit", unit.symbol},
              {"allan",
               {{"tau_s", listed(implied.curves.tau_s)},
                {"deviation", listed(implied.curves.deviation)},
                {"components", std::move(deviations)}}},
              {"spectrum",
               {{"f_hz", listed(implied.curves.f_hz)},
                {"density", listed(implied.curves.density)},
                {"components", std::move(densities)}}},
              {"ratio", to_json(implied.at_measured)}};
}

}  // namespace

Json to_json(const Verdict& verdict) {
  Json facts = Json::array();
  for (const auto& [pointer, value] : verdict.facts) {
    facts.push_back(Json{{"pointer", pointer}, {"value", number(value)}});
  }
  return Json{{"verdict", verdict.sentence},
              {"details", verdict.details},
              {"level", name_of(verdict.level)},
              {"facts", std::move(facts)}};
}

Result<Verdict> verdict_from_json(const Json& channel) {
  auto reported = reported_channel_from_json(channel);
  if (!reported) {
    return fail(reported.error());
  }
  const Contamination contamination = contamination_from_json(channel).value_or(Contamination{});
  return verdict_of(*reported, evidence_of(contamination, reported->haar.scale.size()));
}

Result<Json> channel_summary(const Json& channel) {
  const auto verdict = verdict_from_json(channel);
  return verdict ? Result<Json>(to_json(*verdict)) : fail(verdict.error());
}

Json gravest_summary(const Json& channels) {
  std::vector<Verdict> verdicts;
  std::vector<Json> names;
  for (const Json& channel : channels) {
    if (auto verdict = verdict_from_json(channel)) {
      verdicts.push_back(std::move(*verdict));
      names.push_back(channel.at("channel"));
    }
  }
  const auto gravest = gravest_of(verdicts);
  if (!gravest) {
    return nullptr;
  }
  Json summary = to_json(verdicts[*gravest]);
  summary["channel"] = std::move(names[*gravest]);
  return summary;
}

std::optional<Model> model_of(const Json& fit, Dimension dimension) {
  Faults faults;
  Model model = model_from_json(present(fit.at("processes")), dimension, "/processes", faults);
  if (!faults.none() || model.empty()) {
    return std::nullopt;
  }
  return model;
}

MeasuredDeviation deviation_from_json(const Json& allan) {
  const Json& ci95 = allan.at("ci95");
  return {allan.at("tau_s").get<std::vector<double>>(), values_of(allan.at("deviation")), ends_of(ci95, 0),
          ends_of(ci95, 1)};
}

std::optional<ImpliedBeside> implied_from_json(const Json& fit, const Json& channel) {
  const auto unit = parse_unit(channel.at("unit").get<std::string>());
  const MeasuredDeviation measured = deviation_from_json(channel.at("allan"));
  const std::optional<Model> model =
      unit && !measured.tau_s.empty() ? model_of(fit, unit->dimension) : std::optional<Model>();
  return model ? std::optional(implied_beside(*model, *unit, channel.at("dt_s").get<double>(), measured))
               : std::nullopt;
}

Json implied_by(const Json& fit, const Json& channel) {
  const auto implied = implied_from_json(fit, channel);
  return implied ? to_json(*implied, parse_unit(channel.at("unit").get<std::string>()).value_or(Unit{}))
                 : Json(nullptr);
}

}  // namespace driftlab
