#pragma once
/// Fields of a table that other programs read.
#include <string>

namespace driftlab {

/// As RFC 4180 has it: in quotation marks where the text has a comma, a quotation mark or a line break.
[[nodiscard]] std::string csv_field(const std::string& text);

/// A cell of a pipe table: bars escaped, line breaks as blanks, and nothing that a page would take for a tag or a link.
[[nodiscard]] std::string markdown_field(const std::string& text);

}  // namespace driftlab
