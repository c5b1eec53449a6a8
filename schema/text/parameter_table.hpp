#pragma once
/// A parameter table as people read it: in a spreadsheet, on a terminal, in a paper.
#include "core/campaign/parameter_table.hpp"

#include <string>

namespace driftlab {

/// Three columns per parameter (value, low, high) with units in the header; RFC 4180. Not identifiable: empty cells.
[[nodiscard]] std::string table_to_csv(const ParameterTable& table);

/// Aligned plain text for a terminal of any width: value with interval, `…` where not identifiable, ↑ ↓ for changes,
/// `*` at rows whose recordings hold gross errors or disagree; notes below say which.
[[nodiscard]] std::string table_to_text(const ParameterTable& table);

/// A pipe table for papers and issues, with the same notes below.
[[nodiscard]] std::string table_to_markdown(const ParameterTable& table);

}  // namespace driftlab
