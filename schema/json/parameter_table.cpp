#include "schema/json/parameter_table.hpp"

#include "schema/json/pooled_sensor.hpp"
#include "schema/json/recording_spec.hpp"
#include "schema/json/reported_channel.hpp"

namespace driftlab {
namespace {

/// Named values with how each changed against the first row; null where there is none, and why in `reasons`.
Json cells_to_json(const std::vector<std::pair<std::string, const TableCell*>>& cells, Json& reasons) {
  ReportedValues estimates;
  for (const auto& [name, cell] : cells) {
    estimates.emplace_back(name, cell->estimate);
  }
  Json values = to_json(estimates, reasons);
  for (const auto& [name, cell] : cells) {
    if (Json& value = values[name]; value.is_object()) {
      value["change"] = cell->change ? Json(name_of(*cell->change)) : Json(nullptr);
    }
  }
  return values;
}

Json row_to_json(const TableRow& row, const std::vector<TableColumn>& columns) {
  std::vector<std::pair<std::string, const TableCell*>> cells;
  for (std::size_t c = 0; c < columns.size(); ++c) {
    cells.emplace_back(columns[c].key, &row.cells[c]);
  }
  Json reasons = Json::object();
  Json values = cells_to_json(cells, reasons);
  Json density_reasons = Json::object();
  Json density = cells_to_json({{"N", &row.density}}, density_reasons).at("N");
  return Json{{"condition", to_json(row.condition)},
              {"label", row.label},
              {"density", std::move(density)},
              {"recordings", row.recordings},
              {"contamination", text_or_null(row.contamination)},
              {"pooling", name_of(row.pooling)},
              {"robust", row.robust},
              {"agreement", to_json(row.agreement)},
              {"warnings", row.warnings},
              {"values", std::move(values)},
              {"reasons", std::move(reasons)}};
}

Json to_json(const SheetFigure& figure) {
  const auto end = [](const std::optional<double>& value) { return value ? number(*value) : Json(nullptr); };
  Json reasons = Json::object();
  const Json measured = to_json(ReportedValues{{figure.parameter, figure.measured}}, reasons);
  return Json{{"parameter", figure.parameter},
              {"stated", number(figure.stated)},
              {"unit", figure.unit},
              {"measured", measured.at(figure.parameter)},
              {"ratio", end(figure.ratio)},
              {"ci95", figure.ratio ? Json::array({end(figure.ratio_low), end(figure.ratio_high)}) : Json(nullptr)},
              {"verdict", figure.verdict ? Json(name_of(*figure.verdict)) : Json(nullptr)}};
}

Json to_json(const SheetComparison& comparison) {
  Json figures = Json::array();
  for (const SheetFigure& figure : comparison.figures) {
    figures.push_back(to_json(figure));
  }
  return Json{{"sensor", comparison.sensor},
              {"source", comparison.source},
              {"condition", comparison.condition},
              {"figures", std::move(figures)}};
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
  Json document{
      {"device", table.device},          {"sensor", sensor_of(table.quantity)}, {"axis", text_or_null(table.axis)},
      {"method", name_of(table.method)}, {"model", text_or_null(table.model)},  {"columns", std::move(columns)},
      {"rows", std::move(rows)}};
  if (table.data_sheet) {
    document["data_sheet"] = to_json(*table.data_sheet);
  }
  return document;
}

}  // namespace driftlab
