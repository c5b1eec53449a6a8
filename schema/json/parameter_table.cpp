#include "schema/json/parameter_table.hpp"

#include "schema/json/pooled_sensor.hpp"
#include "schema/json/recording_spec.hpp"
#include "schema/json/reported_channel.hpp"
#include "schema/json/stored_member.hpp"

namespace driftlab {
namespace {

/// Named values with how each compares with the reference row; null where there is none.
struct Cells {
  Json values;
  Json reasons = Json::object();  ///< why there is none, as a sentence
  Json why = Json::object();      ///< and in a word
};

Cells cells_to_json(const std::vector<std::pair<std::string, const TableCell*>>& cells) {
  Cells told;
  ReportedValues estimates;
  for (const auto& [name, cell] : cells) {
    estimates.emplace_back(name, cell->estimate);
  }
  told.values = to_json(estimates, told.reasons);
  for (const auto& [name, cell] : cells) {
    if (Json& value = told.values[name]; value.is_object()) {
      Json no_reasons = Json::object();
      value["change"] = cell->change ? Json(name_of(*cell->change)) : Json(nullptr);
      value["ratio"] = to_json(ReportedValues{{name, cell->ratio}}, no_reasons).at(name);
    } else {
      told.why[name] = name_of(absence_of(cell->estimate.reason));
    }
  }
  return told;
}

Json row_to_json(const TableRow& row, const std::vector<TableColumn>& columns) {
  std::vector<std::pair<std::string, const TableCell*>> cells;
  for (std::size_t c = 0; c < columns.size(); ++c) {
    cells.emplace_back(columns[c].key, &row.cells[c]);
  }
  Cells told = cells_to_json(cells);
  const std::optional<bool> fits = row.fits();
  Json density = cells_to_json({{"N", &row.density}}).values.at("N");
  return Json{{"condition", to_json(row.condition)},
              {"label", row.label},
              {"density", std::move(density)},
              {"recordings", row.recordings},
              {"duration_s", number(row.duration_s)},
              {"fits", fits ? Json(*fits) : Json(nullptr)},
              {"j_test_p", row.j_test_p ? number(*row.j_test_p) : Json(nullptr)},
              {"contamination", text_or_null(row.contamination)},
              {"pooling", name_of(row.pooling)},
              {"robust", row.robust},
              {"agreement", to_json(row.agreement)},
              {"warnings", row.warnings},
              {"values", std::move(told.values)},
              {"reasons", std::move(told.reasons)},
              {"why", std::move(told.why)}};
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
  document["reference"] = table.rows.empty() ? Json(nullptr) : Json(to_text(table.rows[table.reference].condition));
  if (table.structure) {
    document["structure"] = to_json(*table.structure);
  }
  document["model_note"] = text_or_null(table.model_note);
  if (table.data_sheet) {
    document["data_sheet"] = to_json(*table.data_sheet);
  }
  return document;
}

}  // namespace driftlab
