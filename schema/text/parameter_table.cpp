#include "schema/text/parameter_table.hpp"

#include "core/signal/number.hpp"
#include "schema/text/fields.hpp"
#include "schema/text/printed.hpp"

#include <algorithm>
#include <optional>
#include <vector>

namespace driftlab {
namespace {

std::string end_text(const std::optional<double>& end) { return end ? to_four_digits(*end) : "…"; }

std::string value_text(const ReportedValue& estimate) {
  return estimate.value
             ? to_four_digits(*estimate.value) + " [" + end_text(estimate.low) + ", " + end_text(estimate.high) + "]"
             : "…";
}

std::string cell_text(const TableCell& cell) {
  std::string text = value_text(cell.estimate);
  if (cell.change == Change::Up) {
    text += " ↑";
  } else if (cell.change == Change::Down) {
    text += " ↓";
  }
  return text;
}

/// Characters a person sees: UTF-8 continuation bytes take no room.
std::size_t width(const std::string& text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
}

bool contaminated(const TableRow& row) { return row.contamination == "contaminated"; }
bool disagrees(const TableRow& row) { return row.agreement && !row.agreement->agree(); }

/// What a reader must know before using a row: contamination and what the fit itself says against it.
std::string notes_of(const ParameterTable& table) {
  std::string text;
  for (const TableRow& row : table.rows) {
    if (contaminated(row)) {
      text += "! " + row.label + ": gross errors move the variances of this recording" +
              (row.robust ? "; the values are from robust variances.\n" : ".\n");
    }
    if (row.agreement && disagrees(row)) {
      text += "! " + row.label + ": its recordings disagree (p = " + to_four_digits(row.agreement->p) +
              "); the pooled values stand for none of them.\n";
    }
    for (const std::string& warning : row.warnings) {
      text += "! " + row.label + ": " + warning + "\n";
    }
  }
  return text;
}

/// `*` where a note below speaks of the row itself.
std::string marked_label(const TableRow& row) {
  return row.label + (contaminated(row) || disagrees(row) || row.frozen > 0 ? " *" : "");
}

std::string heading_of(const ParameterTable& table) {
  std::string text = table.device + ", " + std::string(sensor_of(table.quantity));
  if (!table.axis.empty()) {
    text += " " + table.axis;
  }
  return text + (table.method == TableMethod::Av ? ", Allan variance"
                                                 : ", GMWM, model " + (table.model.empty() ? "?" : table.model));
}

/// The unit of N; empty where no row has it.
std::string density_unit(const ParameterTable& table) {
  const auto known = std::find_if(table.rows.begin(), table.rows.end(),
                                  [](const TableRow& row) { return !row.density.estimate.unit.empty(); });
  return known == table.rows.end() ? "" : known->density.estimate.unit;
}

/// Method av has N among its columns.
bool shows_density(const ParameterTable& table) { return table.method == TableMethod::Gmwm; }

/// What the data sheet states under that column; empty: nothing.
std::string stated_text(const ParameterTable& table, const std::string& key) {
  if (table.data_sheet) {
    for (const SheetFigure& figure : table.data_sheet->figures) {
      if (figure.parameter == key) {
        return to_four_digits(figure.stated);
      }
    }
  }
  return "";
}

/// The data sheet as a row: what it states under the columns that it speaks of.
std::vector<std::string> sheet_row(const ParameterTable& table, const std::vector<std::string>& keys) {
  std::vector<std::string> line{"data sheet"};
  for (std::size_t i = 1; i < keys.size(); ++i) {
    line.push_back(stated_text(table, keys[i]));
  }
  return line;
}

/// Measured against stated, with the source; a line.
std::string sheet_line(const ParameterTable& table) {
  if (!table.data_sheet) {
    return "";
  }
  std::string text;
  for (const SheetFigure& figure : table.data_sheet->figures) {
    text += (text.empty() ? "" : "; ") + sentence_of(figure);
  }
  return "= " + table.data_sheet->condition + ": " + text + ". " + table.data_sheet->sensor + ": " +
         table.data_sheet->source + ".\n";
}

/// Lines of the table: keys, units, one per row.
std::vector<std::vector<std::string>> grid_of(const ParameterTable& table) {
  std::vector<std::vector<std::string>> grid(2, {"condition"});
  grid[1] = {""};
  if (shows_density(table)) {
    grid[0].emplace_back("N");
    grid[1].push_back(density_unit(table));
  }
  for (const TableColumn& column : table.columns) {
    grid[0].push_back(column.key);
    grid[1].push_back(column.unit);
  }
  for (const TableRow& row : table.rows) {
    std::vector<std::string> line{marked_label(row)};
    if (shows_density(table)) {
      line.push_back(cell_text(row.density));
    }
    for (const TableCell& cell : row.cells) {
      line.push_back(cell_text(cell));
    }
    grid.push_back(std::move(line));
  }
  if (table.data_sheet) {
    grid.push_back(sheet_row(table, grid[0]));
  }
  return grid;
}

constexpr const char* kLegend = "value [95 % interval]; … not identifiable; ↑ ↓ changed against ";

std::string legend_of(const ParameterTable& table) {
  return kLegend + (table.reference == 0 ? std::string("the first row") : table.rows[table.reference].label);
}

std::string exact(const std::optional<double>& value) { return value ? to_text(*value) : ""; }

}  // namespace

std::string table_to_csv(const ParameterTable& table) {
  std::string text = "condition,recordings";
  const auto head = [&](const std::string& key, const std::string& symbol) {
    const std::string unit = symbol.empty() ? "" : " [" + symbol + "]";
    for (const char* const part : {"", " low", " high"}) {
      text.append(",").append(csv_field(std::string(key).append(part).append(unit)));
    }
  };
  const auto figures = [&](const ReportedValue& estimate) {
    text +=
        estimate.value ? "," + exact(estimate.value) + "," + exact(estimate.low) + "," + exact(estimate.high) : ",,,";
  };
  if (shows_density(table)) {
    head("N", density_unit(table));
  }
  for (const TableColumn& column : table.columns) {
    head(column.key, column.unit);
  }
  text += "\r\n";
  for (const TableRow& row : table.rows) {
    std::string recordings;
    for (const std::string& id : row.recordings) {
      recordings += (recordings.empty() ? "" : " ") + id;
    }
    text += csv_field(row.label) + "," + csv_field(recordings);
    if (shows_density(table)) {
      figures(row.density.estimate);
    }
    for (const TableCell& cell : row.cells) {
      figures(cell.estimate);
    }
    text += "\r\n";
  }
  if (table.data_sheet) {
    text += "data sheet," + csv_field(table.data_sheet->sensor + ": " + table.data_sheet->source);
    const auto stated = [&](const std::string& key) {
      const auto found = std::find_if(table.data_sheet->figures.begin(), table.data_sheet->figures.end(),
                                      [&](const SheetFigure& figure) { return figure.parameter == key; });
      text += "," + (found == table.data_sheet->figures.end() ? "" : exact(found->stated)) + ",,";
    };
    if (shows_density(table)) {
      stated("N");
    }
    for (const TableColumn& column : table.columns) {
      stated(column.key);
    }
    text += "\r\n";
  }
  return text;
}

namespace {

/// Cells under their columns, with a rule below the two lines of names and units.
std::string aligned(const std::vector<std::vector<std::string>>& grid) {
  std::vector<std::size_t> widths(grid[0].size(), 0);
  for (const auto& line : grid) {
    for (std::size_t i = 0; i < line.size(); ++i) {
      widths[i] = std::max(widths[i], width(line[i]));
    }
  }
  std::string text;
  for (std::size_t r = 0; r < grid.size(); ++r) {
    std::string line;
    for (std::size_t i = 0; i < grid[r].size(); ++i) {
      line += grid[r][i];
      if (i + 1 < grid[r].size()) {
        line += std::string(widths[i] - width(grid[r][i]) + 2, ' ');
      }
    }
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + "\n";
    if (r == 1) {
      std::string rule;
      for (std::size_t i = 0; i < widths.size(); ++i) {
        rule += std::string(widths[i], '-') + (i + 1 < widths.size() ? "  " : "");
      }
      text += rule + "\n";
    }
  }
  return text;
}

/// Columns that one of the tables has, each once: those of the model with most of them first.
std::vector<TableColumn> columns_of(const std::vector<ParameterTable>& tables) {
  std::vector<TableColumn> columns;
  for (const ParameterTable& table : tables) {
    for (const TableColumn& column : table.columns) {
      const bool known =
          std::any_of(columns.begin(), columns.end(), [&](const TableColumn& one) { return one.key == column.key; });
      if (!known) {
        columns.push_back(column);
      }
    }
  }
  return columns;
}

}  // namespace

std::string table_to_text(const ParameterTable& table, bool legend) {
  return heading_of(table) + (legend ? " (" + legend_of(table) + ")" : std::string()) + "\n\n" +
         aligned(grid_of(table)) + notes_of(table) + sheet_line(table);
}

std::string table_legend() { return std::string("Legend: ") + kLegend + "the first row; – no part of the model.\n"; }

std::string axes_to_text(const std::vector<ParameterTable>& tables) {
  const ParameterTable& first = tables.front();
  const bool gmwm = first.method == TableMethod::Gmwm;
  const std::vector<TableColumn> columns = columns_of(tables);
  std::vector<std::vector<std::string>> grid{{"axis"}, {""}};
  if (gmwm) {
    grid[0].emplace_back("model");
    grid[0].emplace_back("N");
    grid[1].emplace_back("");
    grid[1].push_back(density_unit(first));
  }
  for (const TableColumn& column : columns) {
    grid[0].push_back(column.key);
    grid[1].push_back(column.unit);
  }
  std::string notes;
  for (const ParameterTable& table : tables) {
    const TableRow& row = table.rows.front();
    std::vector<std::string> line{(table.axis.empty() ? "-" : table.axis) +
                                  (contaminated(row) || disagrees(row) ? " *" : "")};
    if (gmwm) {
      line.push_back(table.model);
      line.push_back(cell_text(row.density));
    }
    for (const TableColumn& column : columns) {
      const auto own = std::find_if(table.columns.begin(), table.columns.end(),
                                    [&](const TableColumn& one) { return one.key == column.key; });
      line.push_back(own == table.columns.end()
                         ? "–"
                         : cell_text(row.cells[static_cast<std::size_t>(own - table.columns.begin())]));
    }
    grid.push_back(std::move(line));
    ParameterTable named = table;
    named.rows.front().label = table.axis.empty() ? row.label : table.axis;
    notes += notes_of(named);
    if (named.data_sheet) {
      named.data_sheet->condition = named.rows.front().label;
      notes += sheet_line(named);
    }
  }
  if (first.data_sheet) {
    grid.push_back(sheet_row(first, grid[0]));
  }
  const std::string heading = first.device + ", " + std::string(sensor_of(first.quantity)) + ", " +
                              first.rows.front().label + (gmwm ? ", GMWM" : ", Allan variance");
  return heading + "\n\n" + aligned(grid) + notes;
}

std::string table_to_markdown(const ParameterTable& table) {
  const std::vector<std::vector<std::string>> grid = grid_of(table);
  std::string text = "**" + heading_of(table) + "** (" + legend_of(table) + ")\n\n";
  const auto line = [&](const auto& cell) {
    text += "|";
    for (std::size_t i = 0; i < grid[0].size(); ++i) {
      text += " " + cell(i) + " |";
    }
    text += "\n";
  };
  line([&](std::size_t i) { return grid[0][i] + (grid[1][i].empty() ? "" : " [" + grid[1][i] + "]"); });
  line([](std::size_t) { return std::string("---"); });
  for (std::size_t r = 2; r < grid.size(); ++r) {
    line([&](std::size_t i) { return grid[r][i]; });
  }
  const std::string notes = notes_of(table) + sheet_line(table);
  for (std::size_t start = 0; start < notes.size();) {
    const std::size_t end = notes.find('\n', start);
    text += (start == 0 ? "\n- " : "- ") + notes.substr(start + 2, end - start - 2) + "\n";
    start = end + 1;
  }
  return text;
}

}  // namespace driftlab
