#pragma once
/// A parameter table as people read it: in a spreadsheet, on a terminal, in a paper.
#include "core/campaign/parameter_table.hpp"

#include <string>
#include <vector>

namespace driftlab {

/// Three columns per parameter (value, low, high) with units in the header; RFC 4180. Not identifiable: empty cells.
[[nodiscard]] std::string table_to_csv(const ParameterTable& table);

/// Aligned plain text for a terminal of any width: value with interval, `…` where not identifiable, ↑ ↓ for changes,
/// `*` at rows whose recordings hold gross errors or disagree; notes below say which.
/// `legend`: what the signs mean, behind the heading.
[[nodiscard]] std::string table_to_text(const ParameterTable& table, bool legend = true);

/// Tables of one row each of the axes of one sensor, by one method, as one: a row for each axis with its model, `–`
/// where a parameter is no part of it. `tables` is not empty.
[[nodiscard]] std::string axes_to_text(const std::vector<ParameterTable>& tables);

/// What the signs of both mean, a line.
[[nodiscard]] std::string table_legend();

/// A pipe table for papers and issues, with the same notes below.
[[nodiscard]] std::string table_to_markdown(const ParameterTable& table);

/// A tabular of booktabs for papers, with a caption: digits as the intervals let stand, the ends of the interval
/// beside each value, an arrow where a value changed against the reference row; conditions and names escaped.
[[nodiscard]] std::string table_to_latex(const ParameterTable& table);

}  // namespace driftlab
