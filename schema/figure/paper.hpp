#pragma once
/// Text of a fixed width on a printed page.
#include <cstddef>
#include <string>
#include <string_view>

namespace driftlab::figure {

/// The size of type [tenths of a px] at which lines that are aligned by blanks (two of them somewhere in the line) stay
/// whole between the margins of a portrait A4 page: 11 px, down to 6 px for longer lines; a line longer still wraps.
/// `text` is UTF-8; other lines are sentences, which may wrap.
[[nodiscard]] std::size_t aligned_type_tenths(std::string_view text);

/// The same as a style sheet has it: `9.5px`.
[[nodiscard]] std::string aligned_type_size(std::string_view text);

}  // namespace driftlab::figure
