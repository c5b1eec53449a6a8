#include "schema/json/drive_draft.hpp"

#include <utility>

namespace driftlab {
namespace {

Json source_json(const DraftSource& source) {
  Json columns = Json::object();
  for (const DraftColumn& column : source.columns) {
    Json& meaning = columns[column.name];
    meaning["quantity"] = drive::name_of(column.quantity);
    if (!column.axis.empty()) {
      meaning["axis"] = column.axis;
    }
    if (!column.unit.empty()) {
      meaning["unit"] = column.unit;
    }
  }
  Json time{{"scale", drive::name_of(source.scale)}};
  if (source.rate_hz) {
    time["rate_hz"] = number(*source.rate_hz);
  } else {
    time["column"] = source.time_column;
    time["unit"] = source.time_unit;
  }
  return Json{{"file", source.file}, {"columns", std::move(columns)}, {"time", std::move(time)}};
}

Json level_json(const char* process, const char* parameter, double value, const char* unit) {
  return Json{{"process", process}, {"params", {{parameter, {{"value", number(value)}, {"unit", unit}}}}}};
}

Json model_json(const OrdinaryUnit& unit) {
  return Json{
      {"gyroscope",
       {{"processes", Json::array({level_json("white_noise", "N", unit.gyro_white_deg_sqrt_h, "deg/sqrt(h)"),
                                   level_json("random_walk", "K", unit.gyro_walk_deg_h_sqrt_h, "deg/h/sqrt(h)")})},
        {"constant_bias_sd_deg_s", number(unit.gyro_bias_deg_s)}}},
      {"accelerometer",
       {{"processes", Json::array({level_json("white_noise", "N", unit.force_white_m_s_sqrt_h, "m/s/sqrt(h)"),
                                   level_json("random_walk", "K", unit.force_walk_mg_sqrt_h, "mg/sqrt(h)")})},
        {"constant_bias_sd_mg", number(unit.force_bias_mg)}}}};
}

}  // namespace

Json to_json(const DriveDraft& draft) {
  Json unit = source_json(draft.unit);
  unit["mounting_deg"] = draft.mounting_unknown ? Json("unknown") : Json::array({0, 0, 0});
  Json receiver = source_json(draft.receiver);
  receiver["lever_arm_m"] = Json::array({0, 0, 0});
  if (draft.geoid) {
    receiver["height_above"] = "geoid";
  }
  return Json{{"id", draft.id},
              {"vehicle", drive::name_of(draft.vehicle)},
              {"imu", std::move(unit)},
              {"gnss", std::move(receiver)},
              {"reference", "withheld_fixes"},
              {"model", model_json(draft.model)}};
}

}  // namespace driftlab
