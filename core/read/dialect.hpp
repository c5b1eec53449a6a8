#pragma once
/// How a text table is written: which separator, which decimal sign, where names and units stand. Internal to
/// core/read.
///
/// Nothing in a text file says so; it is found from the first lines alone. Each separator is tried on each line, and
/// the one under which most lines have the same number of cells and most cells are numbers is taken; the earlier of
/// equals in the order comma, semicolon, tab, bar, blanks. A decimal comma is tried wherever the comma does not
/// separate.
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace driftlab::text {

struct Dialect {
  char separator = ',';              ///< ' ' stands for any run of blanks and tabs
  bool decimal_comma = false;        ///< `1,5` is one and a half
  bool trailing_separator = false;   ///< every line ends with a separator behind its last cell
  std::size_t width = 0;             ///< cells of a row; 0: no row was seen
  std::uint64_t first_line = 0;      ///< line of the table's first line (names, or a row), from 1; 0: no line was seen
  bool has_names = false;            ///< `first_line` holds the names
  std::vector<std::string> units;    ///< of a second header line, which follows the names; empty without one
  std::vector<std::size_t> dates;    ///< columns in which the first row holds a date and time
  std::vector<std::size_t> clocks;   ///< columns in which every row seen holds a time of day
  std::vector<std::string> names;    ///< of a comment line above a table without names; empty without one
  std::size_t preamble_lines = 0;    ///< lines above the table that are neither blank nor comments: `Fs,100`
  std::uint64_t preamble_line = 0;   ///< the first of them, from 1
  std::string preamble_text;         ///< what stands in it
  std::optional<double> rate_hz;     ///< a rate that a comment or the preamble states
  double fraction_of_numbers = 0.0;  ///< of the cells seen that are not empty
};

/// The dialect of the text that starts with `head`, the first bytes of the file without a byte-order mark. `whole`: the
/// file ends with `head`; else its last line may be cut and is not looked at.
[[nodiscard]] Dialect find_dialect(std::string_view head, bool whole);

/// True for a line that only people read: it starts with #, // or %.
[[nodiscard]] bool is_comment(std::string_view line);

/// True if all of `cell` is one number in this dialect, `nan` and `inf` included.
[[nodiscard]] bool is_number(std::string_view cell, bool decimal_comma);

/// The cells of one line, trimmed and unquoted (RFC 4180 without line breaks inside quotes).
[[nodiscard]] std::vector<std::string> split_cells(std::string_view line, char separator);

}  // namespace driftlab::text
