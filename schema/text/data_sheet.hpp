#pragma once
/// Data sheets as people read them on a terminal.
#include "core/datasheet/data_sheet.hpp"

#include <string>

namespace driftlab {

/// What is stated of each sensor, a line a figure, with the source; figures that are not stated have no line.
[[nodiscard]] std::string data_sheet_to_text(const DataSheet& sheet);

/// Every sheet, a line each.
[[nodiscard]] std::string data_sheets_to_text();

}  // namespace driftlab
