#pragma once
/// What stands above the rows of delimited text: the names of the columns, and what the dialect says beside them.
/// Internal to core/read.
#include "core/read/dialect.hpp"
#include "core/read/format.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace driftlab::formats {

/// The cells of the first line of the table and what they are.
struct CsvFirstLine {
  std::vector<std::string> cells;  ///< names, their units in brackets behind them; or numbers
  bool named = false;
  bool is_row = false;  ///< the line is a row already
};

/// Takes the first line apart: a header, or a row whose names stand in the comment above it or nowhere.
[[nodiscard]] CsvFirstLine read_first_line(std::string_view line, const text::Dialect& dialect, ColumnSink& sink);

/// The names of the columns; numbers from 0 where `first` is not named. Errors: LimitExceeded (too many, too long),
/// NotANumber (control characters), DuplicateColumn; each names the line, from 1.
[[nodiscard]] Result<ColumnNames> column_names(const CsvFirstLine& first, std::uint64_t line,
                                               const DecodeLimits& limits, ColumnSink& sink);

/// Says what of the dialect a reader of the numbers should know. `comments`: lines above the first row.
void note_dialect(const text::Dialect& dialect, std::uint64_t comments, ColumnSink& sink);

}  // namespace driftlab::formats
