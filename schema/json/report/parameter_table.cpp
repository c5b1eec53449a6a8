/// The report of parameter tables: verdict, figures and every number with its interval.
#include "schema/figure/printed_names.hpp"
#include "schema/json/report/bodies.hpp"
#include "schema/json/report/html.hpp"
#include "schema/json/stored_member.hpp"
#include "schema/json/table_figures.hpp"

#include <string>
#include <vector>

namespace driftlab::page {
namespace {

/// A cell with the digits that its interval lets stand, and the interval; a dash where there is none.
std::string cell_text(const Json& cell) {
  if (!cell.is_object() || !cell.value("value", Json(nullptr)).is_number()) {
    return "—";
  }
  return with_interval(cell.at("value").get<double>(), cell.value("ci95", Json(nullptr)));
}

std::string one_table(const Json& table) {
  std::vector<std::string> columns{"condition"};
  for (const Json& column : table.at("columns")) {
    const std::string unit = printed_unit(text_member(column, "unit"));
    columns.push_back(column_name(column.at("key").get<std::string>()) + (unit.empty() ? "" : ", " + unit));
  }
  std::string rows;
  for (const Json& row : table.at("rows")) {
    std::vector<std::string> cells{text_member(row, "label")};
    for (const Json& column : table.at("columns")) {
      cells.push_back(cell_text(row.at("values").value(column.at("key").get<std::string>(), Json(nullptr))));
    }
    rows += row_html(cells);
  }
  const std::string by = method_of_table(table);
  return table_html(text_member(table, "sensor") + " " + text_member(table, "axis") + (by.empty() ? "" : ", " + by),
                    columns, rows);
}

}  // namespace

std::string parameter_tables_html(const Json& document) {
  const Json summary = document.value("summary", Json(nullptr));
  std::string tables;
  if (document.contains("tables")) {
    for (const Json& table : document.at("tables")) {
      tables += one_table(table);
    }
  } else {
    tables = one_table(document);
  }
  return (summary.is_object() ? verdict_html(text_member(summary, "verdict")) : "") + tables + figures_html(document);
}

}  // namespace driftlab::page
