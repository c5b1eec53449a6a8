#include "schema/json/trend_table.hpp"

#include "schema/json/recording_spec.hpp"

#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <optional>

namespace driftlab {
namespace {

struct Against {
  ConditionKind kind;
  const char* name;
  const char* unit;
};

constexpr std::array kAgainst{Against{ConditionKind::ConstantRate, "rate", "deg/s"},
                              Against{ConditionKind::ConstantAngularAcceleration, "angular_acceleration", "deg/s^2"}};

/// |rate| or |angular acceleration| of a row in degrees; nothing for a row of another kind.
std::optional<double> magnitude(const Json& row, const Against& against) {
  Faults ignored;
  const Condition condition = condition_from_json(row.at("condition"), "", ignored);
  if (condition.kind == ConditionKind::Static) {
    return 0.0;
  }
  if (condition.kind != against.kind || !condition.value) {
    return std::nullopt;
  }
  return std::fabs(*condition.value) * 180.0 / std::numbers::pi;
}

std::string figures(const char* format, double a, double b = 0.0, double c = 0.0) {
  std::array<char, 160> buffer{};
  const int length = std::snprintf(buffer.data(), buffer.size(), format, a, b, c);
  return {buffer.data(), static_cast<std::size_t>(length)};
}

/// The relation as people write it: w in the unit of the abscissa.
std::string formula(const FittedRelation& relation) {
  const double slope = (relation.high - relation.low) / std::pow(relation.scale, relation.exponent);
  switch (relation.relation) {
    case Relation::Constant:
      return figures("%.4g", relation.low);
    case Relation::Linear:
      return figures("%.4g %+.4g w", relation.low, slope);
    case Relation::Power:
      break;
  }
  return figures("%.4g %+.4g w^%.3g", relation.low, slope, relation.exponent);
}

Json relation_json(const FittedRelation& relation) {
  return Json{{"kind", name_of(relation.relation)},    {"formula", formula(relation)},
              {"low", number(relation.low)},           {"high", number(relation.high)},
              {"exponent", number(relation.exponent)}, {"scale", number(relation.scale)},
              {"spread", number(relation.spread)},     {"aicc", number(relation.aicc)}};
}

std::string statement(const Trend& trend) {
  if (trend.direction != 0) {
    return trend.direction > 0 ? "Rises with the dynamics." : "Falls with the dynamics.";
  }
  return trend.equal_p < 0.05 ? "Moves with the condition, but not in one direction." : "Does not move.";
}

Json trend_json(const Trend& trend) {
  Json candidates = Json::array();
  for (const FittedRelation& candidate : trend.candidates) {
    candidates.push_back(relation_json(candidate));
  }
  return Json{
      {"equal",
       {{"statistic", number(trend.equal_statistic)}, {"dof", trend.points.size() - 1}, {"p", number(trend.equal_p)}}},
      {"monotone",
       {{"statistic", number(trend.monotone_statistic)},
        {"p", number(trend.monotone_p)},
        {"direction", trend.direction > 0   ? "up"
                      : trend.direction < 0 ? "down"
                                            : "none"},
        {"few", trend.few}}},
      {"relation", relation_json(trend.relation)},
      {"candidates", std::move(candidates)},
      {"statement", statement(trend)}};
}

bool usable(const Json& cell) {
  const Json& ci = cell["ci95"];
  return ci[0].is_number() && ci[1].is_number() && ci[0].get<double>() > 0.0 &&
         ci[1].get<double>() > ci[0].get<double>() && cell["value"].get<double>() > 0.0;
}

/// One column against one kind of motion; null where fewer than two rows tell.
Json trend_of(const Json& table, const Json& column, const Against& against) {
  const std::string key = column["key"].get<std::string>();
  std::vector<TrendPoint> points;
  Json shown = Json::array();
  Json left_out = Json::array();
  bool moving = false;
  for (const Json& row : table.at("rows")) {
    const auto at = magnitude(row, against);
    if (!at) {
      continue;
    }
    const Json& cell = row["values"][key];
    if (!cell.is_object() || !usable(cell)) {
      left_out.push_back(Json{{"label", row["label"]},
                              {"at", number(*at)},
                              {"reason", cell.is_object() ? Json("The interval is open.")
                                                          : row["reasons"].value(key, Json("Not identified."))}});
      continue;
    }
    moving = moving || *at > 0.0;
    points.push_back(
        {*at, {cell["value"].get<double>(), {cell["ci95"][0].get<double>(), cell["ci95"][1].get<double>()}}});
    shown.push_back(Json{{"label", row["label"]},
                         {"at", number(*at)},
                         {"value", cell["value"]},
                         {"ci95", cell["ci95"]},
                         {"contamination", row.value("contamination", Json())},
                         {"robust", row.value("robust", false)}});
  }
  if (!moving) {
    return nullptr;
  }
  auto trend = fit_trend(std::move(points));
  if (!trend) {
    return nullptr;
  }
  Json document{{"parameter", key},
                {"unit", column["unit"]},
                {"against", {{"kind", against.name}, {"unit", against.unit}}},
                {"points", std::move(shown)},
                {"left_out", std::move(left_out)}};
  document.update(trend_json(*trend));
  return document;
}

}  // namespace

Json build_trends(const Json& table) {
  Json trends = Json::array();
  for (const Against& against : kAgainst) {
    for (const Json& column : table.at("columns")) {
      if (Json trend = trend_of(table, column, against); trend.is_object()) {
        trends.push_back(std::move(trend));
      }
    }
  }
  return Json{{"device", table["device"]}, {"sensor", table["sensor"]}, {"axis", table["axis"]},
              {"method", table["method"]}, {"model", table["model"]},   {"trends", std::move(trends)}};
}

std::string trends_to_text(const Json& document) {
  std::string text;
  for (const Json& trend : document.at("trends")) {
    const Json& direction = trend["monotone"]["direction"];
    const std::string unit = trend["unit"].is_string() ? " " + trend["unit"].get<std::string>() : "";
    text += trend["parameter"].get<std::string>() +
            (direction == "up"     ? " ↑"
             : direction == "down" ? " ↓"
                                   : "") +
            " against |" + (trend["against"]["kind"] == "rate" ? "rate" : "angular acceleration") +
            "|: " + trend["relation"]["formula"].get<std::string>() + unit + ", w in " +
            trend["against"]["unit"].get<std::string>();
    text += figures(" (trend p = %.2g, equal p = %.2g). ", trend["monotone"]["p"].get<double>(),
                    trend["equal"]["p"].get<double>());
    text += trend["statement"].get<std::string>() + "\n";
  }
  return text.empty() ? "No parameter is known under two conditions of one kind of motion.\n" : text;
}

}  // namespace driftlab
