#include "schema/json/channel_summary.hpp"

#include "core/analysis/implied_curves.hpp"
#include "schema/json/error_model.hpp"
#include "schema/json/reported_channel.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace driftlab {
namespace {

constexpr int kCurvePointsPerOctave = 8;
constexpr int kSpectrumPoints = 160;

Json numbers(const std::vector<double>& values, double factor) {
  Json list = Json::array();
  for (const double value : values) {
    list.push_back(number(value * factor));
  }
  return list;
}

Json numbers(const std::vector<std::optional<double>>& values, double factor) {
  Json list = Json::array();
  for (const std::optional<double>& value : values) {
    list.push_back(value ? number(*value * factor) : Json(nullptr));
  }
  return list;
}

/// Frequencies of one length of logarithm from 1/(2 tau) of the longest time to half the rate.
std::vector<double> frequencies(double longest_s, double dt_s) {
  std::vector<double> grid;
  const double low = std::log(0.5 / longest_s);
  const double high = std::log(0.5 / dt_s);
  for (int i = 0; i < kSpectrumPoints; ++i) {
    grid.push_back(std::exp(low + (high - low) * i / (kSpectrumPoints - 1)));
  }
  return grid;
}

/// The processes of a fit without those that it has nothing of: their level is 0, and was not given.
Json present(const Json& processes) {
  Json kept = Json::array();
  for (const Json& process : processes) {
    bool none = false;
    const Json reasons = process.value("reasons", Json::object());
    for (const Json& reason : reasons) {
      none = none || absence_of(reason.get<std::string>()) == Absence::NoneFound;
    }
    if (!none) {
      kept.push_back(process);
    }
  }
  return kept;
}

/// The part of an implied document that is taken at the times that were measured.
Json at_measured(const Model& model, const Json& allan, double dt_s, double factor) {
  std::vector<double> halves;
  for (const Json& tau : allan.at("tau_s")) {
    halves.push_back(std::round(tau.get<double>() / dt_s));
  }
  const ImpliedCurves curves = implied_curves(model, dt_s, halves, {});
  Json deviation = Json::array();
  Json ratio = Json::array();
  Json ci95 = Json::array();
  for (std::size_t i = 0; i < halves.size(); ++i) {
    const double implied = curves.deviation[i] * factor;
    const auto over = [&](const Json& measured) {
      return measured.is_number() && implied > 0.0 ? number(measured.get<double>() / implied) : Json(nullptr);
    };
    deviation.push_back(number(implied));
    ratio.push_back(over(allan.at("deviation").at(i)));
    ci95.push_back(Json::array({over(allan.at("ci95").at(i).at(0)), over(allan.at("ci95").at(i).at(1))}));
  }
  return Json{{"tau_s", allan.at("tau_s")},
              {"deviation", std::move(deviation)},
              {"measured_over_model", std::move(ratio)},
              {"ci95", std::move(ci95)}};
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

Result<Json> channel_summary(const Json& channel) {
  auto reported = reported_channel_from_json(channel);
  if (!reported) {
    return fail(reported.error());
  }
  GrossErrorEvidence evidence;
  if (channel.contains("contamination") && channel["contamination"].is_object()) {
    const Json& contamination = channel["contamination"];
    evidence.not_gaussian = contamination.value("not_gaussian", false);
    evidence.disjoint_scales = contamination.value("disjoint_scales", Json::array()).size();
  }
  evidence.scales = reported->haar.scale.size();
  return to_json(verdict_of(*reported, evidence));
}

Json gravest_summary(const Json& channels) {
  constexpr std::array<std::string_view, 3> kByGravity{"fine", "look", "wrong"};
  const auto gravity = [&](const Json& summary) {
    return std::find(kByGravity.begin(), kByGravity.end(), summary.at("level").get<std::string>());
  };
  Json gravest = nullptr;
  for (const Json& channel : channels) {
    auto summary = channel_summary(channel);
    if (summary && (gravest.is_null() || gravity(*summary) > gravity(gravest))) {
      gravest = std::move(*summary);
      gravest["channel"] = channel.at("channel");
    }
  }
  return gravest;
}

std::optional<Model> model_of(const Json& fit, Dimension dimension) {
  Faults faults;
  Model model = model_from_json(present(fit.at("processes")), dimension, "/processes", faults);
  if (!faults.none() || model.empty()) {
    return std::nullopt;
  }
  return model;
}

Json implied_by(const Json& fit, const Json& channel) {
  const auto unit = parse_unit(channel.at("unit").get<std::string>());
  const double dt_s = channel.at("dt_s").get<double>();
  const Json& allan = channel.at("allan");
  if (!unit || allan.at("tau_s").empty()) {
    return nullptr;
  }
  const std::optional<Model> fitted = model_of(fit, unit->dimension);
  if (!fitted) {
    return nullptr;
  }
  const Model& model = *fitted;
  const double longest = allan.at("tau_s").back().get<double>();
  const ImpliedCurves curves = implied_curves(model, dt_s, octave_grid(longest * 1.25 / dt_s, kCurvePointsPerOctave),
                                              frequencies(longest, dt_s));
  const double factor = 1.0 / unit->factor;
  Json deviations = Json::array();
  Json densities = Json::array();
  for (const ImpliedComponent& component : curves.components) {
    deviations.push_back(Json{{"process", component.process}, {"deviation", numbers(component.deviation, factor)}});
    densities.push_back(Json{{"process", component.process}, {"density", numbers(component.density, factor * factor)}});
  }
  return Json{{"unit", unit->symbol},
              {"allan", Json{{"tau_s", numbers(curves.tau_s, 1.0)},
                             {"deviation", numbers(curves.deviation, factor)},
                             {"components", std::move(deviations)}}},
              {"spectrum", Json{{"f_hz", numbers(curves.f_hz, 1.0)},
                                {"density", numbers(curves.density, factor * factor)},
                                {"components", std::move(densities)}}},
              {"ratio", at_measured(model, allan, dt_s, factor)}};
}

}  // namespace driftlab
