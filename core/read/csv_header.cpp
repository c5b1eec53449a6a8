#include "core/read/csv_header.hpp"

#include "core/read/csv_left_out.hpp"
#include "core/read/text_shape.hpp"
#include "core/signal/with_count.hpp"

#include <algorithm>
#include <set>
#include <utility>

namespace driftlab::formats {
namespace {

tl::unexpected<Error> at_line(std::uint64_t line, ErrorCode code, const std::string& what) {
  const std::string number = std::to_string(line);
  return fail(code, "Line " + number + " " + what, {{"row", number}});
}

Result<std::string> column_name(const std::string& cell, std::size_t column, bool named, std::uint64_t line,
                                const DecodeLimits& limits, ColumnSink& sink) {
  std::string name = named ? text::to_utf8(cell) : std::to_string(column);
  if (name.empty()) {
    name = std::to_string(column);
    sink.note("Column " + std::to_string(column + 1) + " has no name in the header; it is called '" + name + "'.");
  }
  if (name.size() > limits.max_name_bytes) {
    return at_line(line, ErrorCode::LimitExceeded,
                   "has a column name longer than " + std::to_string(limits.max_name_bytes) + " bytes.");
  }
  const auto control = [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F; };
  if (std::any_of(name.begin(), name.end(), control)) {
    return at_line(line, ErrorCode::NotANumber, "holds control characters; is this a text file?");
  }
  return name;
}

/// Names between blanks with their units behind a blank too, `t [s] gx [deg/s]`: units go to their names where that
/// makes as many names as a row has cells.
void join_units(std::vector<std::string>& cells, std::size_t width) {
  std::vector<std::string> joined;
  for (const std::string& cell : cells) {
    if (!joined.empty() && (cell.starts_with('[') || cell.starts_with('('))) {
      joined.back() += " " + cell;
    } else {
      joined.push_back(cell);
    }
  }
  if (joined.size() == width) {
    cells = std::move(joined);
  }
}

/// The name of a column of dates or times of day with the unit that they get; a form, `(hh:mm:ss)`, is none.
void say_seconds(std::string& name) {
  const std::size_t open = name.find_last_of("([");
  if (open != std::string::npos && name.find(':', open) != std::string::npos) {
    name = text::trim(name.substr(0, open));
  }
  name += name.empty() || name.back() == ')' ? "" : " (s)";
}

}  // namespace

CsvFirstLine read_first_line(std::string_view line, const text::Dialect& dialect, ColumnSink& sink) {
  CsvFirstLine first{text::split_cells(line, dialect.separator), dialect.has_names, !dialect.has_names};
  std::vector<std::string>& cells = first.cells;
  if (dialect.trailing_separator && cells.size() > dialect.width && cells.back().empty()) {
    cells.pop_back();
  }
  if (!dialect.has_names) {
    first.named = dialect.names.size() == cells.size();
    if (first.named) {
      sink.note("The names of the columns are those of the comment above the first row.");
      cells = dialect.names;
    }
    return first;
  }
  if (dialect.separator == ' ' && cells.size() > dialect.width) {
    join_units(cells, dialect.width);
  }
  for (std::size_t i = 0; i < std::min(cells.size(), dialect.units.size()); ++i) {
    cells[i] += dialect.units[i].empty() ? "" : " (" + dialect.units[i] + ")";
  }
  for (const auto* const columns : {&dialect.dates, &dialect.clocks}) {
    for (const std::size_t column : *columns) {  // as numbers they are seconds, and their name has to say so
      if (column < cells.size()) {
        say_seconds(cells[column]);
      }
    }
  }
  return first;
}

Result<ColumnNames> column_names(const CsvFirstLine& first, std::uint64_t line, const DecodeLimits& limits,
                                 ColumnSink& sink) {
  if (first.cells.size() > limits.max_columns) {
    return at_line(line, ErrorCode::LimitExceeded,
                   "has " + std::to_string(first.cells.size()) + " columns; at most " +
                       std::to_string(limits.max_columns) + " are read.");
  }
  ColumnNames names;
  std::set<std::string> seen;
  for (std::size_t i = 0; i < first.cells.size(); ++i) {
    auto name = column_name(first.cells[i], i, first.named, line, limits, sink);
    if (!name) {
      return fail(name.error());
    }
    if (!seen.insert(*name).second) {
      const std::string row = std::to_string(line);
      return fail(ErrorCode::DuplicateColumn,
                  "Two columns are called '" + *name + "'; give each its own name, or leave the line of names out " +
                      "with --skip-lines " + row + " and call columns by their numbers, from 0.",
                  {{"row", row}, {"column", *name}});
    }
    names.push_back(std::move(*name));
  }
  return names;
}

void note_dialect(const text::Dialect& dialect, std::uint64_t comments, ColumnSink& sink) {
  if (comments > 0) {
    sink.note(with_count(comments, "comment line above the first row was skipped.",
                         "comment lines above the first row were skipped."));
  }
  if (dialect.preamble_lines > 0 && !dialect.has_names) {
    CsvLeftOut banner;
    banner.add(dialect.preamble_line, dialect.preamble_lines, dialect.preamble_text);
    banner.note(sink, "line above the rows is no sample and was skipped",
                "lines above the rows are no samples and were skipped");
  } else if (dialect.preamble_lines > 0) {
    sink.note(with_count(dialect.preamble_lines, "line above the names of the columns is no sample and was skipped.",
                         "lines above the names of the columns are no samples and were skipped."));
  }
  if (!dialect.units.empty()) {
    sink.note("The second header line is read as the units of the columns.");
  }
  if (dialect.decimal_comma) {
    sink.note("Numbers are read with a decimal comma.");
  }
  if (dialect.trailing_separator) {
    sink.note("The separator behind the last cell of each row is ignored.");
  }
}

}  // namespace driftlab::formats
