#include "schema/text/in_print.hpp"

#include "schema/figure/printed_names.hpp"

namespace driftlab {
namespace {

void put_in_print(TableColumn& column) {
  column.key = column_name(column.key);
  column.unit = printed_unit(column.unit);
}

}  // namespace

ParameterTable in_print(ParameterTable table) {
  for (TableColumn& column : table.columns) {
    put_in_print(column);
  }
  for (TableRow& row : table.rows) {
    row.density.estimate.unit = printed_unit(row.density.estimate.unit);
  }
  if (table.data_sheet) {
    for (SheetFigure& figure : table.data_sheet->figures) {
      figure.unit = printed_unit(figure.unit);
    }
  }
  return table;
}

TrendTable in_print(TrendTable table) {
  for (ColumnTrend& column : table.trends) {
    put_in_print(column.column);
  }
  return table;
}

}  // namespace driftlab
