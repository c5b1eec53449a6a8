#pragma once
/// What a text looks like from its first lines: which separator, which line end. Internal to core/read.
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace driftlab::text {

enum class Shape {
  NotText,       ///< control characters in the first lines
  NotATable,     ///< words
  LoneReturns,   ///< lines that end with carriage returns alone
  Commas,        ///< a table separated by commas
  SingleColumn,  ///< one number a line, with or without a name above
  Semicolons,
  Tabs,
  Spaces,
};

/// The shape of the text that starts with `head`; comment lines (#), blank lines and a byte-order mark are skipped.
[[nodiscard]] Shape shape_of(std::string_view head);

/// `text` without spaces, tabs and carriage returns at both ends.
[[nodiscard]] std::string_view trim(std::string_view text);

/// True if all of `text` is one number, `nan` and `inf` included.
[[nodiscard]] bool is_number(std::string_view text);

/// True for nan, inf, infinity with or without sign, in any case.
[[nodiscard]] bool is_non_finite_word(std::string_view text);

/// A few characters of a cell for an error message: printable ASCII, at most 32 of them, in quotes.
[[nodiscard]] std::string excerpt(std::string_view cell);

/// Seconds since 1970-01-01 UTC of a date and time as ISO 8601 writes it: `2025-06-14 21:17:02+00:00`,
/// `2025-06-14T21:17:02.5Z`, `20250614T211702.5`, also with slashes, `2025/06/14 21:17:02`; without a zone it is UTC.
/// Nothing for any other text, nor for a day that the calendar does not have.
[[nodiscard]] std::optional<double> seconds_of_date(std::string_view text);

/// Seconds since midnight of a time of day, `23:59:50`, `9:05:03.250`; nothing for any other text.
[[nodiscard]] std::optional<double> seconds_of_day(std::string_view text);

/// `text` as UTF-8: unchanged if it is, else every byte read as ISO 8859-1.
[[nodiscard]] std::string to_utf8(std::string_view text);

/// `text` as UTF-8, of which only the bytes that belong to no character are read as ISO 8859-1: sentences that hold
/// names from a file.
[[nodiscard]] std::string mended_utf8(std::string_view text);

/// At most `most` bytes of text in UTF-8, whole characters.
[[nodiscard]] std::string_view front_of(std::string_view text, std::size_t most);

inline constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

}  // namespace driftlab::text
