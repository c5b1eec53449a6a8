#pragma once
/// A data sheet as a document: what its manufacturer states, and the figures that measured ones are compared with.
#include "core/datasheet/data_sheet.hpp"
#include "schema/json/json.hpp"

namespace driftlab {

/// Members that are not stated are absent.
[[nodiscard]] Json to_json(const DataSheet& sheet);

/// {"items": [...], "next_cursor": null} of these sheets.
[[nodiscard]] Json data_sheets_document(const std::vector<const DataSheet*>& sheets);

}  // namespace driftlab
