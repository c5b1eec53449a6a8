// A parameter table for papers.
#include "core/signal/significant.hpp"
#include "schema/text/parameter_table.hpp"

#include <cstdio>
#include <map>

namespace driftlab {
namespace {

/// Text with what LaTeX would take for a command escaped.
std::string latex_escaped(const std::string& text) {
  static const std::map<char, std::string> k_escapes{{'\\', "\\textbackslash{}"},
                                                     {'{', "\\{"},
                                                     {'}', "\\}"},
                                                     {'$', "\\$"},
                                                     {'&', "\\&"},
                                                     {'#', "\\#"},
                                                     {'_', "\\_"},
                                                     {'%', "\\%"},
                                                     {'^', "\\^{}"},
                                                     {'~', "\\~{}"}};
  std::string safe;
  for (const char c : text) {
    const auto found = k_escapes.find(c);
    safe += found == k_escapes.end() ? std::string(1, c) : found->second;
  }
  return safe;
}

/// A number as `significant` writes it, with its power of ten as print has it.
std::string latex_number(const std::string& written) {
  const std::size_t power = written.find('e');
  return power == std::string::npos ? written
                                    : written.substr(0, power) + "\\cdot 10^{" + written.substr(power + 1) + "}";
}

/// An end of the interval with the decimals that its value was given.
std::string latex_end(double end, const std::string& value) {
  if (value.find('e') != std::string::npos) {
    return latex_number(significant(end));
  }
  const std::size_t point = value.find('.');
  char buffer[64];
  std::snprintf(buffer, sizeof buffer, "%.*f",
                point == std::string::npos ? 0 : static_cast<int>(value.size() - point - 1), end);
  return buffer;
}

std::string latex_cell(const TableCell& cell) {
  const ReportedValue& estimate = cell.estimate;
  if (!estimate.value) {
    return "\\dots";
  }
  const std::string value = significant(*estimate.value, estimate.low, estimate.high);
  const std::string arrow = cell.change == Change::Up     ? "\\,\\uparrow"
                            : cell.change == Change::Down ? "\\,\\downarrow"
                                                          : "";
  return "$" + latex_number(value) + "\\;[" + (estimate.low ? latex_end(*estimate.low, value) : "0") + ",\\," +
         (estimate.high ? latex_end(*estimate.high, value) : "\\infty") + "]" + arrow + "$";
}

std::string latex_heading(const std::string& key, const std::string& unit) {
  return latex_escaped(key) + (unit.empty() ? "" : " [" + latex_escaped(unit) + "]");
}

}  // namespace

std::string table_to_latex(const ParameterTable& table) {
  const bool gmwm = table.method == TableMethod::Gmwm;
  std::string text =
      "% \\usepackage{booktabs}\n\\begin{table}\n\\centering\n\\caption{" + latex_escaped(table.device) + ", " +
      std::string(sensor_of(table.quantity)) + (table.axis.empty() ? "" : " $" + latex_escaped(table.axis) + "$") +
      ", " + (gmwm ? "GMWM, model " + latex_escaped(table.model) : "Allan variance") +
      ": value and 95\\,\\% interval; $\\uparrow$ $\\downarrow$ changed against " +
      latex_escaped(table.rows[table.reference].label) + "; \\dots{} not identifiable.}\n\\begin{tabular}{l" +
      std::string(table.columns.size() + (gmwm ? 1 : 0), 'l') + "}\n\\toprule\ncondition";
  if (gmwm) {
    text += " & " + latex_heading("N", table.rows.front().density.estimate.unit);
  }
  for (const TableColumn& column : table.columns) {
    text += " & " + latex_heading(column.key, column.unit);
  }
  text += " \\\\\n\\midrule\n";
  for (const TableRow& row : table.rows) {
    text += latex_escaped(row.label);
    if (gmwm) {
      text += " & " + latex_cell(row.density);
    }
    for (const TableCell& cell : row.cells) {
      text += " & " + latex_cell(cell);
    }
    text += " \\\\\n";
  }
  return text + "\\bottomrule\n\\end{tabular}\n\\end{table}\n";
}

}  // namespace driftlab
