/// Comma-separated values: an optional header row, then one sample a row.
///
/// Two readers of the same bytes: the fast one knows nothing but numbers, commas and line ends and gives up on anything
/// else; the careful one reads that row again, with quotes and blanks, and names what is wrong with it.
#include "core/read/decimal.hpp"
#include "core/read/formats.hpp"
#include "core/read/text_shape.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace driftlab::formats {
namespace {

constexpr std::size_t kBatchValues = 16384;

/// Skips blanks inside a line.
const char* skip_blanks(const char* p) {
  while (*p == ' ' || *p == '\t') {
    ++p;
  }
  return p;
}

class CsvDecoder {
 public:
  CsvDecoder(ByteSource& source, const DecodeLimits& limits, ColumnSink& sink, const RunControl& control)
      : source_(source), limits_(limits), sink_(sink), control_(control) {}

  Status run();

 private:
  Status take_lines(std::string_view lines);
  Status take_line(std::string_view line);
  Status take_header(std::string_view line);
  Status begin(const std::vector<std::string>& fields, bool named);
  const char* take_rows_fast(const char* p, const char* end);
  Status take_row_carefully(std::string_view line);
  [[nodiscard]] Result<double> take_cell(std::string_view cell, std::size_t column) const;
  Status flush();

  [[nodiscard]] std::string line_name() const { return "Line " + std::to_string(line_); }
  [[nodiscard]] tl::unexpected<Error> at_line(ErrorCode code, const std::string& what) const {
    return fail(code, line_name() + " " + what, {{"row", std::to_string(line_)}});
  }
  [[nodiscard]] tl::unexpected<Error> at_cell(ErrorCode code, std::size_t column, const std::string& what) const {
    return fail(code, line_name() + ", column '" + names_[column] + "': " + what,
                {{"row", std::to_string(line_)}, {"column", names_[column]}});
  }
  [[nodiscard]] Status too_long() const {
    return at_line(ErrorCode::LimitExceeded,
                   "is longer than " + std::to_string(limits_.max_line_bytes) + " bytes; is this a table?");
  }

  ByteSource& source_;
  const DecodeLimits& limits_;
  ColumnSink& sink_;
  const RunControl& control_;
  std::uint64_t line_ = 0;        ///< number of the line being read, from 1
  std::uint64_t blank_line_ = 0;  ///< a blank line that is an error if a row follows it
  std::uint64_t comments_ = 0;
  std::uint64_t rows_ = 0;
  ColumnNames names_;  ///< empty until the first row is seen
  std::vector<double> batch_;
  std::size_t filled_ = 0;
};

Status CsvDecoder::run() {
  if (auto head = source_.view(text::kByteOrderMark.size()); !head) {
    return fail(head.error());
  } else if (head->starts_with(text::kByteOrderMark)) {
    source_.consume(text::kByteOrderMark.size());
  }
  std::size_t want = 1;
  while (true) {
    if (control_.stop.stop_requested()) {
      return fail(ErrorCode::Cancelled, "Decoding was cancelled.");
    }
    auto view = source_.view(want);
    if (!view) {
      return fail(view.error());
    }
    const std::size_t line_feed = view->rfind('\n');
    if (line_feed != std::string_view::npos) {
      if (auto status = take_lines(view->substr(0, line_feed + 1)); !status) {
        return status;
      }
      source_.consume(line_feed + 1);
      want = 1;
    } else if (view->size() < want) {  // the end: a last line without a line feed
      const std::string last = std::string(*view) + "\n";
      source_.consume(view->size());
      if (auto status = last.size() > 1 ? take_lines(last) : Status{}; !status) {
        return status;
      }
      break;
    } else if (view->size() > limits_.max_line_bytes) {
      ++line_;
      return too_long();
    } else {
      want = 2 * view->size();
    }
  }
  if (auto status = flush(); !status) {
    return status;
  }
  if (names_.empty()) {
    return fail(ErrorCode::EmptyInput, "The file holds no rows, only blank lines or comments.");
  }
  if (rows_ == 0) {
    return fail(ErrorCode::NoSamples, "The file has a header and no samples under it.");
  }
  return {};
}

/// `lines` ends with a line feed.
Status CsvDecoder::take_lines(std::string_view lines) {
  const char* p = lines.data();
  const char* const end = p + lines.size();
  while (p < end) {
    if (!names_.empty() && blank_line_ == 0) {
      p = take_rows_fast(p, end);
      if (filled_ == batch_.size()) {
        if (auto status = flush(); !status) {
          return status;
        }
        continue;
      }
      if (p == end) {
        break;
      }
    }
    const char* const line_end = std::find(p, end, '\n');
    ++line_;
    if (static_cast<std::size_t>(line_end - p) > limits_.max_line_bytes) {
      return too_long();
    }
    if (auto status = take_line({p, static_cast<std::size_t>(line_end - p)}); !status) {
      return status;
    }
    p = line_end + 1;
  }
  return {};
}

/// Rows of plain numbers from `p`, until the batch is full or a row is anything else; returns where that row begins.
const char* CsvDecoder::take_rows_fast(const char* p, const char* const end) {
  const std::size_t width = names_.size();
  double* into = batch_.data() + filled_;
  double* const full = batch_.data() + batch_.size();
  while (p < end && into != full) {
    const char* q = p;
    for (std::size_t column = 0; column < width; ++column) {
      q = decimal::parse(*q == ' ' ? skip_blanks(q) : q, into[column]);
      if (q == nullptr || !std::isfinite(into[column])) {
        filled_ = static_cast<std::size_t>(into - batch_.data());
        return p;
      }
      if (*q != ',') {
        q = skip_blanks(q);
        q += *q == '\r' && column + 1 == width ? 1 : 0;
      }
      if (*q != (column + 1 == width ? '\n' : ',')) {
        filled_ = static_cast<std::size_t>(into - batch_.data());
        return p;
      }
      ++q;
    }
    if (static_cast<std::size_t>(q - p) > limits_.max_line_bytes) {
      break;
    }
    p = q;
    into += width;
    ++line_;
    ++rows_;
  }
  filled_ = static_cast<std::size_t>(into - batch_.data());
  return p;
}

Status CsvDecoder::take_line(std::string_view line) {
  const std::string_view content = text::trim(line);
  if (content.empty()) {
    blank_line_ = names_.empty() || blank_line_ != 0 ? blank_line_ : line_;
    return {};
  }
  if (names_.empty()) {
    if (content.front() == '#') {
      ++comments_;
      return {};
    }
    return take_header(content);
  }
  if (blank_line_ != 0) {
    line_ = blank_line_;
    return at_line(ErrorCode::RaggedRow, "is empty, but more rows follow it.");
  }
  return take_row_carefully(line);
}

/// The first row. It is a row of samples if all of it is numbers, or part of it numbers that nobody uses as names.
Status CsvDecoder::take_header(std::string_view line) {
  if (line.find('\0') != std::string_view::npos) {
    return at_line(ErrorCode::NotANumber, "holds a NUL byte; is this a text file?");
  }
  const std::vector<std::string> fields = text::split_fields(line);
  bool all_numbers = true;
  bool a_measured_number = false;
  bool counts_up = fields.size() > 2;  // pandas writes 0,1,2,... above columns without names
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const bool number = text::is_number(fields[i]);
    all_numbers = all_numbers && number;
    counts_up = counts_up && fields[i] == std::to_string(i);
    a_measured_number = a_measured_number || (number && fields[i].find_first_not_of("0123456789") != std::string::npos);
  }
  if (comments_ > 0) {
    sink_.note(std::to_string(comments_) + " comment lines above the first row were skipped.");
  }
  if (!counts_up && (all_numbers || a_measured_number)) {
    auto status = begin(fields, false);
    return status ? take_row_carefully(line) : status;
  }
  return begin(fields, true);
}

Status CsvDecoder::begin(const std::vector<std::string>& fields, bool named) {
  if (fields.size() > limits_.max_columns) {
    return at_line(ErrorCode::LimitExceeded, "has " + std::to_string(fields.size()) + " columns; at most " +
                                                 std::to_string(limits_.max_columns) + " are read.");
  }
  ColumnLayout layout;
  layout.has_header = named;
  std::set<std::string> seen;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    std::string name = named ? text::to_utf8(fields[i]) : std::to_string(i);
    if (name.empty()) {
      name = std::to_string(i);
      sink_.note("Column " + std::to_string(i + 1) + " has no name in the header; it is called '" + name + "'.");
    }
    if (name.size() > limits_.max_name_bytes) {
      return at_line(ErrorCode::LimitExceeded,
                     "has a column name longer than " + std::to_string(limits_.max_name_bytes) + " bytes.");
    }
    const auto control = [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F; };
    if (std::any_of(name.begin(), name.end(), control)) {
      return at_line(ErrorCode::NotANumber, "holds control characters; is this a text file?");
    }
    if (!seen.insert(name).second) {
      return fail(ErrorCode::DuplicateColumn, "Two columns are called '" + name + "'; give each its own name.",
                  {{"row", std::to_string(line_)}, {"column", name}});
    }
    layout.names.push_back(std::move(name));
  }
  names_ = layout.names;
  batch_.resize(std::max<std::size_t>(kBatchValues / names_.size(), 1) * names_.size());
  return sink_.begin(layout);
}

Status CsvDecoder::take_row_carefully(std::string_view line) {
  const std::vector<std::string> fields = text::split_fields(line);
  const std::size_t common = std::min(fields.size(), names_.size());
  for (std::size_t column = 0; column < common && fields.size() == names_.size(); ++column) {
    auto value = take_cell(fields[column], column);
    if (!value) {
      return fail(value.error());
    }
    batch_[filled_ + column] = *value;
  }
  if (fields.size() != names_.size()) {
    return at_line(ErrorCode::RaggedRow, "has " + std::to_string(fields.size()) + " values; the first row has " +
                                             std::to_string(names_.size()) + ".");
  }
  filled_ += names_.size();
  ++rows_;
  return filled_ == batch_.size() ? flush() : Status{};
}

Result<double> CsvDecoder::take_cell(std::string_view cell, std::size_t column) const {
  if (cell.empty()) {
    return at_cell(ErrorCode::NotANumber, column, "the cell is empty.");
  }
  if (text::is_non_finite_word(cell)) {
    return at_cell(ErrorCode::NonFinite, column, text::excerpt(cell) + " is not a finite number.");
  }
  if (cell.find('\0') != std::string_view::npos) {
    return at_cell(ErrorCode::NotANumber, column, "the cell holds a NUL byte.");
  }
  const std::string terminated(cell);
  double value = 0.0;
  if (decimal::parse(terminated.c_str(), value) != terminated.c_str() + terminated.size()) {
    return at_cell(ErrorCode::NotANumber, column, text::excerpt(cell) + " is not a number.");
  }
  if (!std::isfinite(value)) {
    return at_cell(ErrorCode::OutOfRange, column, text::excerpt(cell) + " is larger than a double can hold.");
  }
  return value;
}

Status CsvDecoder::flush() {
  auto status = filled_ > 0 ? sink_.rows(std::span(batch_).first(filled_)) : Status{};
  filled_ = 0;
  return status;
}

int sniff(std::string_view head) {
  const text::Shape shape = text::shape_of(head);
  return shape == text::Shape::Commas || shape == text::Shape::SingleColumn ? 40 : 0;
}

Status decode(ByteSource& source, const DecodeLimits& limits, ColumnSink& sink, const RunControl& control) {
  return CsvDecoder(source, limits, sink, control).run();
}

}  // namespace

const Format kCsv{"csv", "comma-separated values with or without a header row", sniff, decode};

}  // namespace driftlab::formats
