#include "schema/json/population.hpp"

#include "schema/json/recording_spec.hpp"
#include "schema/json/stored_channel.hpp"
#include "schema/json/stored_member.hpp"

namespace driftlab {
namespace {

Json optional_end(const std::optional<double>& value) { return value ? number(*value) : Json(nullptr); }

Json quantity_of(const ReportedValue& value) {
  return value.value ? Json{{"value", number(*value.value)},
                            {"unit", value.unit},
                            {"ci95", Json::array({optional_end(value.low), optional_end(value.high)})}}
                     : Json(nullptr);
}

Json place_to_json(const DevicePlace& place) {
  return Json{{"device", place.device},     {"estimate", quantity_of(place.estimate)},
              {"z", number(place.z)},       {"quantile", optional_end(place.quantile)},
              {"p", optional_end(place.p)}, {"p_holm", optional_end(place.p_holm)},
              {"outlying", place.outlying}};
}

Json population_row_to_json(const PopulationRow& row) {
  const Population& population = row.population;
  Json places = Json::array();
  for (const DevicePlace& place : population.places) {
    places.push_back(place_to_json(place));
  }
  Json left_out = Json::array();
  for (const LeftOut& one : population.left_out) {
    left_out.push_back(Json{{"device", one.device}, {"reason", one.reason}});
  }
  const bool described = row.reason.empty();
  return Json{{"sensor", sensor_of(row.quantity)},
              {"axis", text_or_null(row.axis)},
              {"condition", to_json(row.condition)},
              {"label", row.label},
              {"parameter", row.parameter},
              {"mean", quantity_of(population.mean)},
              {"spread", described ? number(population.spread) : Json(nullptr)},
              {"prediction", population.predicted_low ? Json::array({number(*population.predicted_low),
                                                                     optional_end(population.predicted_high)})
                                                      : Json(nullptr)},
              {"heterogeneity", described ? Json{{"q", number(population.heterogeneity_q)},
                                                 {"dof", population.heterogeneity_dof()},
                                                 {"p", number(population.heterogeneity_p)}}
                                          : Json(nullptr)},
              {"reason", text_or_null(row.reason)},
              {"places", std::move(places)},
              {"left_out", std::move(left_out)}};
}

}  // namespace

Json to_json(const PopulationReport& report, const Verdict& summary) {
  Json rows = Json::array();
  Json outlying = Json::array();
  for (const PopulationRow& row : report.rows) {
    rows.push_back(population_row_to_json(row));
    for (const DevicePlace& place : row.population.places) {
      if (place.outlying) {
        outlying.push_back(Json{{"device", place.device},
                                {"sensor", sensor_of(row.quantity)},
                                {"axis", text_or_null(row.axis)},
                                {"label", row.label},
                                {"parameter", row.parameter}});
      }
    }
  }
  return Json{{"model", report.model},
              {"summary", to_json(summary)},
              {"devices", report.devices},
              {"rows", std::move(rows)},
              {"outlying", std::move(outlying)}};
}

}  // namespace driftlab
