#include "core/read/dialect.hpp"

#include "core/read/text_shape.hpp"
#include "core/signal/infer_role.hpp"
#include "core/signal/number.hpp"
#include "core/signal/recording.hpp"
#include "core/signal/text.hpp"
#include "core/signal/unit.hpp"

#include <algorithm>
#include <array>
#include <map>

namespace driftlab::text {
namespace {

constexpr std::size_t kLinesSeen = 60;
constexpr std::string_view kBlanks = " \t";

struct Line {
  std::uint64_t number = 0;
  std::string_view text;
};

/// The first lines of a text, without blank ones; comments apart.
struct Head {
  std::vector<Line> content;
  std::vector<Line> comments;  ///< only those above the first content line
};

Head take_head(std::string_view text, bool whole) {
  Head head;
  std::uint64_t number = 0;
  while (!text.empty() && head.content.size() < kLinesSeen) {
    const std::size_t end = text.find('\n');
    if (end == std::string_view::npos && !whole && number > 0) {
      break;
    }
    const std::string_view line = text.substr(0, end);  // its tab at the end may be a separator
    const std::string_view content = trim(line);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    ++number;
    if (is_comment(content)) {
      if (head.content.empty()) {
        head.comments.push_back({number, content});
      }
    } else if (!content.empty()) {
      head.content.push_back({number, line});
    }
  }
  return head;
}

/// What a line is under one separator and decimal sign.
struct Cells {
  std::vector<std::string> cells;
  std::size_t numbers = 0;
  std::size_t filled = 0;
  bool measured = false;   ///< a number that nobody uses as a name: not digits alone
  bool counts_up = false;  ///< 0, 1, 2, ...: what pandas writes above columns without names
};

Cells look_at(std::string_view line, char separator, bool decimal_comma) {
  Cells seen;
  seen.cells = split_cells(line, separator);
  seen.counts_up = seen.cells.size() > 2;
  for (std::size_t i = 0; i < seen.cells.size(); ++i) {
    const std::string& cell = seen.cells[i];
    const bool number = !cell.empty() && is_number(cell, decimal_comma);
    seen.filled += cell.empty() ? 0 : 1;
    seen.numbers += number ? 1 : 0;
    seen.measured = seen.measured || (number && cell.find_first_not_of("0123456789") != std::string::npos);
    seen.counts_up = seen.counts_up && cell == std::to_string(i);
  }
  return seen;
}

/// A line of numbers and not of names.
bool is_row(const Cells& line) {
  return !line.counts_up && line.numbers > 0 && (line.numbers == line.filled || line.measured);
}

/// One way to read the lines, and how well it fits.
struct Reading {
  char separator = ',';
  bool decimal_comma = false;
  std::size_t width = 0;
  bool trailing = false;
  double numbers = 0.0;  ///< fraction of the filled cells of rows
  double score = 0.0;
  std::vector<Cells> lines;
};

/// The most frequent width among lines that hold a number; of equals the earliest.
std::size_t common_width(const std::vector<Cells>& lines) {
  std::map<std::size_t, std::size_t> count;
  for (const Cells& line : lines) {
    count[line.cells.size()] += line.numbers > 0 ? 1 : 0;
  }
  std::size_t best = 0;
  std::size_t most = 0;
  for (const Cells& line : lines) {
    const std::size_t seen = count[line.cells.size()];
    if (seen > most) {
      most = seen;
      best = line.cells.size();
    }
  }
  return best;
}

/// True if every row of the common width has nothing behind its last separator.
bool ends_with_separator(const std::vector<Cells>& lines, std::size_t width) {
  bool seen = false;
  for (const Cells& line : lines) {
    if (line.cells.size() == width && line.numbers > 0) {
      seen = true;
      if (!line.cells.back().empty()) {
        return false;
      }
    }
  }
  return seen && width > 1;
}

/// The line above the first row of the common width, where the names of the columns stand if anywhere.
const Cells& line_of_names(const std::vector<Cells>& lines, std::size_t width) {
  const auto row = std::find_if(lines.begin(), lines.end(),
                                [width](const Cells& line) { return line.cells.size() == width && line.numbers > 0; });
  return row == lines.begin() || row == lines.end() ? lines.front() : *(row - 1);
}

Reading read_as(const Head& head, char separator, bool decimal_comma) {
  Reading reading{separator, decimal_comma, 0, false, 0.0, 0.0, {}};
  for (const Line& line : head.content) {
    reading.lines.push_back(look_at(line.text, separator, decimal_comma));
  }
  reading.width = common_width(reading.lines);
  std::size_t rows = 0;
  std::size_t numbers = 0;
  std::size_t filled = 0;
  for (const Cells& line : reading.lines) {
    if (line.cells.size() == reading.width && line.numbers > 0) {
      ++rows;
      numbers += line.numbers;
      filled += line.filled;
    }
  }
  if (rows == 0) {
    return reading;
  }
  reading.trailing = separator != ' ' && ends_with_separator(reading.lines, reading.width);
  // A header line of names has one cell less than such rows, or ends with the separator as they do.
  const auto named_trailing = [&](const Cells& line) {
    return line.cells.size() + 1 == reading.width || line.cells.back().empty();
  };
  if (reading.trailing && !named_trailing(line_of_names(reading.lines, reading.width))) {
    reading.trailing = false;
  }
  reading.width -= reading.trailing ? 1 : 0;
  reading.numbers = static_cast<double>(numbers) / static_cast<double>(filled);
  reading.score = static_cast<double>(rows) / static_cast<double>(head.content.size()) * reading.numbers;
  const std::size_t first = reading.lines.front().cells.size();
  if (first != reading.width && first != reading.width + (reading.trailing ? 1 : 0)) {
    reading.score *= 0.25;  // a separator that the line of names does not know is hardly one
  }
  return reading;
}

std::optional<Reading> best_reading(const Head& head) {
  std::optional<Reading> best;
  for (const char separator : {',', ';', '\t', '|', ' '}) {
    for (const bool decimal_comma : {false, true}) {
      if (separator == ',' && decimal_comma) {
        continue;
      }
      Reading reading = read_as(head, separator, decimal_comma);
      const bool a_table = reading.width > 1 && (separator != ' ' || reading.numbers > 0.5);
      if (a_table && (!best || reading.score > best->score * (1.0 + 1e-9))) {
        best = std::move(reading);
      }
    }
  }
  return best;
}

/// The line of names below a preamble of one or two cells a line; 0 where the table starts with the first line.
std::size_t find_start(const Reading& reading) {
  const auto& lines = reading.lines;
  const auto short_line = [](const Cells& line) { return line.cells.size() <= 2; };
  for (std::size_t i = 1; i + 1 < lines.size() && reading.width > 2 && short_line(lines[i - 1]); ++i) {
    const bool names = lines[i].cells.size() > 2 && lines[i].numbers == 0 && lines[i].cells.size() <= reading.width + 1;
    if (names && is_row(lines[i + 1]) && lines[i + 1].cells.size() >= reading.width) {
      return i;
    }
  }
  return 0;
}

/// True for a line that names a quantity: the names of columns, though fewer than a row has cells.
bool names_quantities(const Cells& line) {
  return std::any_of(line.cells.begin(), line.cells.end(),
                     [](const std::string& cell) { return infer_role(cell).quantity != Quantity::Unspecified; });
}

/// The first row below a banner, lines with words that are narrower than the rows: what a board says of itself before
/// it measures. 0 where the table starts with the first line, and where what is narrower may be names: as R writes them
/// above rows that begin with their number, or one name above numbers with a decimal comma.
std::size_t find_row_below_banner(const Reading& reading) {
  const auto& lines = reading.lines;
  const auto row =
      std::find_if(lines.begin(), lines.end(), [&](const Cells& line) { return line.cells.size() >= reading.width; });
  if (reading.width <= 2 || row == lines.end() || !is_row(*row)) {
    return 0;
  }
  const std::string& first_cell = row->cells.front();
  const bool numbered = first_cell == "0" || first_cell == "1";
  const bool banner = std::all_of(lines.begin(), row, [&](const Cells& line) {
    const bool one_less = line.cells.size() > 1 && line.cells.size() + 1 == reading.width;
    return line.numbers < line.filled && !(one_less && numbered) && !names_quantities(line);
  });
  return banner ? static_cast<std::size_t>(row - lines.begin()) : 0;
}

std::string_view without_brackets(std::string_view cell) {
  const bool bracketed =
      cell.size() > 1 && ((cell.front() == '(' && cell.back() == ')') || (cell.front() == '[' && cell.back() == ']'));
  return bracketed ? cell.substr(1, cell.size() - 2) : cell;
}

/// The second header line, if it is one of units.
std::vector<std::string> find_units(const Reading& reading, std::size_t names) {
  const auto& lines = reading.lines;
  if (names + 2 >= lines.size() || lines[names + 1].numbers > 0 || !is_row(lines[names + 2]) ||
      lines[names + 1].cells.size() != lines[names].cells.size()) {
    return {};
  }
  std::vector<std::string> units;
  bool known = false;
  for (const std::string& cell : lines[names + 1].cells) {
    units.emplace_back(without_brackets(cell));
    known = known || (!units.back().empty() && parse_unit(units.back()).has_value());
  }
  return known ? units : std::vector<std::string>{};
}

/// Columns of the given line that hold a date and time.
std::vector<std::size_t> find_dates(const Reading& reading, std::size_t row) {
  std::vector<std::size_t> dates;
  for (std::size_t i = 0; row < reading.lines.size() && i < reading.lines[row].cells.size(); ++i) {
    if (seconds_of_date(reading.lines[row].cells[i])) {
      dates.push_back(i);
    }
  }
  return dates;
}

/// Columns that hold a time of day in every row from the given line on.
std::vector<std::size_t> find_clocks(const Reading& reading, std::size_t row) {
  std::vector<std::size_t> clocks;
  for (std::size_t i = 0; row < reading.lines.size() && i < reading.lines[row].cells.size(); ++i) {
    const bool clock = std::all_of(
        reading.lines.begin() + static_cast<std::ptrdiff_t>(row), reading.lines.end(), [&](const Cells& line) {
          return line.cells.size() != reading.lines[row].cells.size() || seconds_of_day(line.cells[i]).has_value();
        });
    if (clock) {
      clocks.push_back(i);
    }
  }
  return clocks;
}

std::string_view comment_text(std::string_view line) {
  const std::size_t start = line.find_first_not_of("#/% \t");
  return start == std::string_view::npos ? std::string_view{} : line.substr(start);
}

/// Cells of a comment line; a separator inside brackets does not separate.
std::vector<std::string> split_outside_brackets(std::string_view line, char separator) {
  std::vector<std::string> cells(1);
  int depth = 0;
  for (const char c : line) {
    depth += c == '(' || c == '[' ? 1 : c == ')' || c == ']' ? -1 : 0;
    if (c == separator && depth == 0) {
      cells.emplace_back();
    } else {
      cells.back() += c;
    }
  }
  for (std::string& cell : cells) {
    cell = std::string(trim(cell));
  }
  return cells;
}

/// Names in the last comment line above a table without a header, as NumPy's savetxt writes them.
std::vector<std::string> find_commented_names(const Head& head, const Reading& reading) {
  if (head.comments.empty()) {
    return {};
  }
  const std::string_view line = comment_text(head.comments.back().text);
  auto names = reading.separator == ' ' ? split_cells(line, ' ') : split_outside_brackets(line, reading.separator);
  const bool fits = names.size() == reading.width &&
                    std::none_of(names.begin(), names.end(),
                                 [](const std::string& name) { return name.empty() || is_number(name, false); });
  return fits ? names : std::vector<std::string>{};
}

/// A rate that a line such as `Sample rate: 50.0Hz` or `Fs,100` states.
std::optional<double> stated_rate(std::string_view line) {
  const std::string lower = lower_case(line.substr(0, 200));
  constexpr std::array<std::string_view, 7> kNames{
      "sample rate", "sampling rate", "sample_rate", "sampling frequency", "sampling_rate", "update rate", "fs"};
  for (const std::string_view name : kNames) {
    const std::size_t at = lower.find(name);
    if (at == std::string::npos || (name == "fs" && at != 0)) {
      continue;
    }
    std::string_view rest = std::string_view(lower).substr(at + name.size());
    const std::size_t value = rest.find_first_not_of(" \t:=,;\"");
    if (value == 0 || value == std::string_view::npos) {
      continue;
    }
    rest = rest.substr(value);
    const std::string_view digits = rest.substr(0, rest.find_first_not_of("0123456789.e+"));
    const std::string_view unit = trim(rest.substr(digits.size()));
    const auto rate = parse_double(digits);
    if (rate && is_sampling_rate(*rate) && (unit.empty() || unit.starts_with("hz"))) {
      return rate;
    }
  }
  return std::nullopt;
}

}  // namespace

bool is_comment(std::string_view line) {
  return !line.empty() && (line.front() == '#' || line.front() == '%' || line.starts_with("//"));
}

bool is_number(std::string_view cell, bool decimal_comma) {
  if (!decimal_comma) {
    return is_number(cell);
  }
  if (cell.find('.') != std::string_view::npos) {
    return false;
  }
  std::string pointed(cell);
  std::replace(pointed.begin(), pointed.end(), ',', '.');
  return is_number(pointed);
}

std::vector<std::string> split_cells(std::string_view line, char separator) {
  std::vector<std::string> cells;
  const bool blanks = separator == ' ';
  const auto is_blank = [&](char c) { return c == ' ' || (c == '\t' && separator != '\t') || c == '\r'; };
  const std::string_view stops = blanks ? kBlanks : std::string_view(&separator, 1);
  std::size_t i = 0;
  while (true) {
    while (i < line.size() && is_blank(line[i])) {
      ++i;
    }
    if (blanks && i == line.size() && !cells.empty()) {
      return cells;
    }
    std::string cell;
    if (i < line.size() && line[i] == '"') {
      for (++i; i < line.size(); ++i) {
        if (line[i] == '"' && (i + 1 == line.size() || line[i + 1] != '"')) {
          ++i;
          break;
        }
        i += line[i] == '"' ? 1 : 0;  // a doubled quote is one
        cell += line[i];
      }
    }
    const std::size_t end = std::min(line.find_first_of(stops, i), line.size());
    cell += trim(line.substr(i, end - i));
    cells.push_back(std::move(cell));
    if (end == line.size()) {
      return cells;
    }
    i = end + 1;
  }
}

Dialect find_dialect(std::string_view text, bool whole) {
  const Head head = take_head(text, whole);
  Dialect dialect;
  for (const Line& comment : head.comments) {
    const auto rate = stated_rate(comment_text(comment.text));
    dialect.rate_hz = dialect.rate_hz ? dialect.rate_hz : rate;
  }
  if (head.content.empty()) {
    return dialect;
  }
  auto reading = best_reading(head);
  if (!reading) {  // one column, or no numbers at all
    const Shape shape = shape_of(text);
    const char separator = shape == Shape::Semicolons ? ';' : shape == Shape::Tabs ? '\t' : ',';
    reading = read_as(head, separator, false);
  }
  const std::size_t below_preamble = find_start(*reading);
  const std::size_t start = below_preamble > 0 ? below_preamble : find_row_below_banner(*reading);
  for (std::size_t i = 0; i < start; ++i) {
    const auto rate = stated_rate(head.content[i].text);
    dialect.rate_hz = dialect.rate_hz ? dialect.rate_hz : rate;
  }
  dialect.separator = reading->separator;
  dialect.decimal_comma = reading->decimal_comma;
  dialect.trailing_separator = reading->trailing;
  dialect.width = reading->width;
  dialect.fraction_of_numbers = reading->numbers;
  dialect.first_line = head.content[start].number;
  dialect.preamble_lines = start;
  dialect.preamble_line = start > 0 ? head.content.front().number : 0;
  dialect.preamble_text = start > 0 ? std::string(trim(head.content.front().text)) : "";
  dialect.has_names = !is_row(reading->lines[start]);
  dialect.units = dialect.has_names ? find_units(*reading, start) : std::vector<std::string>{};
  const std::size_t row = start + (dialect.has_names ? 1 : 0) + (dialect.units.empty() ? 0 : 1);
  dialect.clocks = find_clocks(*reading, row);
  if (dialect.has_names) {
    dialect.dates = find_dates(*reading, row);
  } else {
    dialect.names = find_commented_names(head, *reading);
  }
  return dialect;
}

}  // namespace driftlab::text
