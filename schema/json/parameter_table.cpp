#include "schema/json/parameter_table.hpp"

#include "schema/json/pooled_sensor.hpp"
#include "schema/json/recording_spec.hpp"
#include "schema/json/reported_channel.hpp"

namespace driftlab {
namespace {

Json row_to_json(const TableRow& row, const std::vector<TableColumn>& columns) {
  Json reasons = Json::object();
  ReportedValues estimates;
  for (std::size_t c = 0; c < columns.size(); ++c) {
    estimates.emplace_back(columns[c].key, row.cells[c].estimate);
  }
  Json values = to_json(estimates, reasons);
  for (std::size_t c = 0; c < columns.size(); ++c) {
    if (Json& cell = values[columns[c].key]; cell.is_object()) {
      const std::optional<Change>& change = row.cells[c].change;
      cell["change"] = change ? Json(name_of(*change)) : Json(nullptr);
    }
  }
  return Json{{"condition", to_json(row.condition)}, {"label", row.label},
              {"recordings", row.recordings},        {"contamination", text_or_null(row.contamination)},
              {"pooling", name_of(row.pooling)},     {"robust", row.robust},
              {"agreement", to_json(row.agreement)}, {"warnings", row.warnings},
              {"values", std::move(values)},         {"reasons", std::move(reasons)}};
}

}  // namespace

Json to_json(const ParameterTable& table) {
  Json columns = Json::array();
  for (const TableColumn& column : table.columns) {
    columns.push_back(Json{{"key", column.key}, {"unit", text_or_null(column.unit)}});
  }
  Json rows = Json::array();
  for (const TableRow& row : table.rows) {
    rows.push_back(row_to_json(row, table.columns));
  }
  return Json{
      {"device", table.device},          {"sensor", sensor_of(table.quantity)}, {"axis", text_or_null(table.axis)},
      {"method", name_of(table.method)}, {"model", text_or_null(table.model)},  {"columns", std::move(columns)},
      {"rows", std::move(rows)}};
}

}  // namespace driftlab
