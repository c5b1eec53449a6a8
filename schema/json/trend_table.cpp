#include "schema/json/trend_table.hpp"

#include "schema/json/stored_member.hpp"

namespace driftlab {
namespace {

Json relation_json(const FittedRelation& relation) {
  return Json{{"kind", name_of(relation.relation)},    {"formula", formula(relation)},
              {"low", number(relation.low)},           {"high", number(relation.high)},
              {"exponent", number(relation.exponent)}, {"scale", number(relation.scale)},
              {"spread", number(relation.spread)},     {"aicc", number(relation.aicc)}};
}

Json point_json(const TrendTablePoint& point) {
  return Json{{"label", point.label},
              {"at", number(point.at)},
              {"value", number(point.estimate.value)},
              {"ci95", interval(point.estimate.ci95)},
              {"contamination", text_or_null(point.contamination)},
              {"robust", point.robust}};
}

const char* direction_of(const Trend& trend) {
  return trend.direction > 0 ? "up" : trend.direction < 0 ? "down" : "none";
}

Json column_json(const ColumnTrend& column) {
  const Trend& trend = column.trend;
  Json points = Json::array();
  for (const TrendTablePoint& point : column.points) {
    points.push_back(point_json(point));
  }
  Json left_out = Json::array();
  for (const LeftOutPoint& point : column.left_out) {
    left_out.push_back(Json{{"label", point.label}, {"at", number(point.at)}, {"reason", point.reason}});
  }
  Json candidates = Json::array();
  for (const FittedRelation& candidate : trend.candidates) {
    candidates.push_back(relation_json(candidate));
  }
  return Json{
      {"parameter", column.column.key},
      {"unit", text_or_null(column.column.unit)},
      {"against", {{"kind", name_of(column.against)}, {"unit", unit_of(column.against)}}},
      {"points", std::move(points)},
      {"left_out", std::move(left_out)},
      {"equal",
       {{"statistic", number(trend.equal_statistic)}, {"dof", trend.equal_dof()}, {"p", number(trend.equal_p)}}},
      {"monotone",
       {{"statistic", number(trend.monotone_statistic)},
        {"p", number(trend.monotone_p)},
        {"direction", direction_of(trend)},
        {"few", trend.few}}},
      {"relation", relation_json(trend.relation)},
      {"candidates", std::move(candidates)},
      {"statement", statement(trend)}};
}

}  // namespace

Json to_json(const TrendTable& table) {
  Json trends = Json::array();
  for (const ColumnTrend& column : table.trends) {
    trends.push_back(column_json(column));
  }
  return Json{
      {"device", table.device},          {"sensor", sensor_of(table.quantity)}, {"axis", text_or_null(table.axis)},
      {"method", name_of(table.method)}, {"model", text_or_null(table.model)},  {"trends", std::move(trends)}};
}

}  // namespace driftlab
