/// Delimited text: an optional header row, then one sample a row, in any of the dialects of dialect.hpp.
///
/// Two readers of the same bytes: the fast one knows nothing but numbers, separators and line ends and gives up on
/// anything else; the careful one reads that row again, with quotes, blanks, holes and words. A cell that is no number
/// becomes a missing sample that says what stood there (core/signal/missing.hpp); only a file without any number is
/// refused for it.
#include "core/read/csv_cells.hpp"
#include "core/read/csv_header.hpp"
#include "core/read/csv_left_out.hpp"
#include "core/read/csv_time.hpp"
#include "core/read/decimal.hpp"
#include "core/read/dialect.hpp"
#include "core/read/formats.hpp"
#include "core/read/stated_scale.hpp"
#include "core/read/text_shape.hpp"
#include "core/signal/missing.hpp"
#include "core/signal/with_count.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace driftlab::formats {
namespace {

constexpr std::size_t kBatchValues = 16384;

class CsvDecoder {
 public:
  CsvDecoder(ByteSource& source, const DecodeLimits& limits, ColumnSink& sink, const RunControl& control)
      : source_(source), limits_(limits), sink_(sink), control_(control) {}

  Status run();

 private:
  /// Rows of plain numbers from the first pointer, until the batch is full or a row is anything else; returns where
  /// that row begins.
  using FastReader = const char* (CsvDecoder::*)(const char*, const char*);
  template <char Separator, char Point>
  const char* take_rows_fast(const char* p, const char* end);
  template <char Separator, char Point>
  const char* take_cell_fast(const char* p, bool last, double& value) const;
  static FastReader choose_fast_reader(const text::Dialect& dialect);

  Status start();
  Status take_pieces();
  Status take_lines(std::string_view lines);
  Status take_line(std::string_view line);
  Status take_first_line(std::string_view line);
  Status begin(const CsvFirstLine& first);
  Status take_row_carefully(std::string_view line);
  void close_row(double* row);
  Status flush();
  Status finish();

  [[nodiscard]] tl::unexpected<Error> at_line(ErrorCode code, const std::string& what) const {
    const std::string line = std::to_string(line_);
    return fail(code, "Line " + line + " " + what, {{"row", line}});
  }
  [[nodiscard]] Status too_long() const {
    return at_line(ErrorCode::LimitExceeded,
                   "is longer than " + std::to_string(limits_.max_line_bytes) + " bytes; is this a table?");
  }

  ByteSource& source_;
  const DecodeLimits& limits_;
  ColumnSink& sink_;
  const RunControl& control_;
  text::Dialect dialect_;
  FastReader fast_ = nullptr;
  std::uint64_t line_ = 0;       ///< number of the line being read, from 1
  CsvLeftOut blank_;             ///< blank lines between rows; those at the end are none
  std::uint64_t blank_run_ = 0;  ///< blank lines since the last row
  CsvLeftOut words_;             ///< lines between rows that hold words alone
  bool torn_ = false;            ///< the last line ends within a row
  std::uint64_t comments_ = 0;
  std::uint64_t inner_comments_ = 0;  ///< between rows
  std::uint64_t rows_ = 0;
  bool last_line_ = false;     ///< the line being read has no end: the file stops in it
  std::uint64_t header_ = 0;   ///< line of the names; 0 without
  bool units_follow_ = false;  ///< the next line is the second of two header lines
  ColumnNames names_;          ///< of the file's columns; empty until the first row is seen
  std::size_t stride_ = 0;     ///< values a row: the file's columns, and the time made from a stated rate
  TimeFromRate time_;
  CsvCells cells_;
  std::vector<double> batch_;
  std::size_t filled_ = 0;
};

Status CsvDecoder::run() {
  if (auto status = start(); !status) {
    return status;
  }
  if (auto status = take_pieces(); !status) {
    return status;
  }
  if (auto status = flush(); !status) {
    return status;
  }
  return finish();
}

/// Skips a byte-order mark and finds the dialect.
Status CsvDecoder::start() {
  auto head = source_.view(text::kByteOrderMark.size());
  if (!head) {
    return fail(head.error());
  }
  if (head->starts_with(text::kByteOrderMark)) {
    source_.consume(text::kByteOrderMark.size());
  }
  head = source_.view(kSniffBytes);
  if (!head) {
    return fail(head.error());
  }
  dialect_ = text::find_dialect(head->substr(0, kSniffBytes), head->size() < kSniffBytes);
  return {};
}

Status CsvDecoder::take_pieces() {
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
      last_line_ = true;
      source_.consume(view->size());
      return last.size() > 1 ? take_lines(last) : Status{};
    } else if (view->size() > limits_.max_line_bytes) {
      ++line_;
      return too_long();
    } else {
      want = 2 * view->size();
    }
  }
}

/// `lines` ends with a line feed.
Status CsvDecoder::take_lines(std::string_view lines) {
  const char* p = lines.data();
  const char* const end = p + lines.size();
  while (p < end) {
    if (!names_.empty() && blank_run_ == 0 && !units_follow_ && dialect_.clocks.empty()) {
      p = (this->*fast_)(p, end);
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

template <char Separator>
const char* skip_blanks(const char* p) {
  while (*p == ' ' || (Separator != '\t' && *p == '\t')) {
    ++p;
  }
  return p;
}

/// One number or hole and what ends it; nullptr where it is anything else.
template <char Separator, char Point>
const char* CsvDecoder::take_cell_fast(const char* p, bool last, double& value) const {
  p = *p == ' ' || *p == '\t' ? skip_blanks<Separator>(p) : p;
  const char* q = decimal::parse<Point>(p, value);
  if (q == nullptr) {
    const bool hole =
        Separator != ' ' && (*p == Separator || (last && names_.size() > 1 && (*p == '\n' || *p == '\r')));
    if (!hole) {
      return nullptr;
    }
    value = missing_sample(Missing::Empty, line_ + 1);
    q = p;
  } else if (!std::isfinite(value)) {
    return nullptr;
  }
  if constexpr (Separator == ' ') {
    const char* const behind = skip_blanks<Separator>(q);
    if (!last) {
      return behind != q && *behind != '\n' && *behind != '\r' ? behind : nullptr;
    }
    q = behind;
  } else {
    if (*q != Separator) {
      q = skip_blanks<Separator>(q);
    }
    if (!last) {
      return *q == Separator ? q + 1 : nullptr;
    }
    if (dialect_.trailing_separator && *q == Separator) {
      q = skip_blanks<Separator>(q + 1);
    }
  }
  q += *q == '\r' ? 1 : 0;
  return *q == '\n' ? q + 1 : nullptr;
}

template <char Separator, char Point>
const char* CsvDecoder::take_rows_fast(const char* p, const char* const end) {
  const std::size_t width = names_.size();
  double* into = batch_.data() + filled_;
  double* const full = batch_.data() + batch_.size();
  while (p < end && into != full) {
    const char* q = p;
    for (std::size_t column = 0; column < width && q != nullptr; ++column) {
      q = take_cell_fast<Separator, Point>(q, column + 1 == width, into[column]);
    }
    if (q == nullptr || static_cast<std::size_t>(q - p) > limits_.max_line_bytes) {
      break;
    }
    if (!cells_.any_number()) {
      if (std::all_of(into, into + width, [](double value) { return std::isnan(value); })) {
        break;  // the careful reader keeps the fault
      }
      cells_.number_met();
    }
    p = q;
    ++line_;
    close_row(into);
    into += stride_;
  }
  filled_ = static_cast<std::size_t>(into - batch_.data());
  return p;
}

CsvDecoder::FastReader CsvDecoder::choose_fast_reader(const text::Dialect& dialect) {
  switch (dialect.separator) {
    case ';':
      return dialect.decimal_comma ? &CsvDecoder::take_rows_fast<';', ','> : &CsvDecoder::take_rows_fast<';', '.'>;
    case '\t':
      return dialect.decimal_comma ? &CsvDecoder::take_rows_fast<'\t', ','> : &CsvDecoder::take_rows_fast<'\t', '.'>;
    case '|':
      return dialect.decimal_comma ? &CsvDecoder::take_rows_fast<'|', ','> : &CsvDecoder::take_rows_fast<'|', '.'>;
    case ' ':
      return dialect.decimal_comma ? &CsvDecoder::take_rows_fast<' ', ','> : &CsvDecoder::take_rows_fast<' ', '.'>;
    default:
      return &CsvDecoder::take_rows_fast<',', '.'>;
  }
}

Status CsvDecoder::take_line(std::string_view line) {
  const std::string_view content = text::trim(line);
  if (names_.empty()) {
    comments_ += text::is_comment(content) ? 1 : 0;
    if (content.empty() || text::is_comment(content) || line_ < dialect_.first_line) {
      return {};
    }
    return take_first_line(line);  // a tab at its front separates an empty name
  }
  if (content.empty()) {
    ++blank_run_;
    return {};
  }
  if (text::is_comment(content)) {
    ++inner_comments_;
    return {};
  }
  if (units_follow_) {
    units_follow_ = false;
    return {};
  }
  if (blank_run_ > 0) {
    blank_.add(line_ - blank_run_, blank_run_, "");
    blank_run_ = 0;
  }
  return take_row_carefully(line);
}

/// The first line of the table: names, or a row already.
Status CsvDecoder::take_first_line(std::string_view line) {
  if (line.find('\0') != std::string_view::npos) {
    return at_line(ErrorCode::NotANumber, "holds a NUL byte; is this a text file?");
  }
  if (dialect_.first_line == 0) {  // the first lines were all comments
    dialect_ = text::find_dialect(line, true);
  }
  fast_ = choose_fast_reader(dialect_);
  const CsvFirstLine first = read_first_line(line, dialect_, sink_);
  header_ = dialect_.has_names ? line_ : 0;
  units_follow_ = dialect_.has_names && !dialect_.units.empty();
  auto status = begin(first);
  return status && first.is_row ? take_row_carefully(line) : status;
}

Status CsvDecoder::begin(const CsvFirstLine& first) {
  note_dialect(dialect_, comments_, sink_);
  auto names = column_names(first, line_, limits_, sink_);
  if (!names) {
    return fail(names.error());
  }
  names_ = std::move(*names);
  cells_ = CsvCells(names_, dialect_.decimal_comma, dialect_.clocks);
  ColumnLayout layout;
  layout.has_header = first.named;
  layout.names = names_;
  if (dialect_.rate_hz) {
    time_ = TimeFromRate(names_, *dialect_.rate_hz);
    sink_.note(time_.sentence());
  }
  if (time_.needed()) {
    layout.names.emplace_back(TimeFromRate::kName);
  }
  stride_ = layout.names.size();
  batch_.resize(std::max<std::size_t>(kBatchValues / stride_, 1) * stride_);
  return sink_.begin(layout);
}

Status CsvDecoder::take_row_carefully(std::string_view line) {
  std::vector<std::string> cells = text::split_cells(line, dialect_.separator);
  if (dialect_.trailing_separator && cells.size() == names_.size() + 1 && cells.back().empty()) {
    cells.pop_back();
  }
  if (is_interruption(cells, names_, dialect_.decimal_comma)) {
    words_.add(line_, 1, line);
    return {};
  }
  if (cells.size() != names_.size() && last_line_ && cells.size() < names_.size() && rows_ > 0) {
    torn_ = true;
    return {};
  }
  if (cells.size() > names_.size() && rows_ == 0 && header_ > 0) {
    const std::string header = std::to_string(header_);
    return at_line(ErrorCode::RaggedRow, "has " + with_count(cells.size(), "value") + "; the header in line " + header +
                                             " has " + std::to_string(names_.size()) +
                                             "; correct it, or if that line is no header, leave it out with "
                                             "--skip-lines " +
                                             header + ".");
  }
  if (cells.size() != names_.size()) {
    return at_line(ErrorCode::RaggedRow, "has " + with_count(cells.size(), "value") + "; the first row has " +
                                             std::to_string(names_.size()) + "; correct or delete that line.");
  }
  for (std::size_t column = 0; column < cells.size(); ++column) {
    batch_[filled_ + column] = cells_.take(cells[column], column, line_);
  }
  close_row(batch_.data() + filled_);
  filled_ += stride_;
  return filled_ == batch_.size() ? flush() : Status{};
}

/// What follows from a row of the file's own columns.
void CsvDecoder::close_row(double* row) {
  if (time_.needed()) {
    row[stride_ - 1] = time_.at(rows_, row);
  }
  ++rows_;
}

Status CsvDecoder::flush() {
  auto status = filled_ > 0 ? sink_.rows(std::span(batch_).first(filled_)) : Status{};
  filled_ = 0;
  return status;
}

Status CsvDecoder::finish() {
  if (names_.empty()) {
    return fail(ErrorCode::EmptyInput, "The file holds no rows, only blank lines or comments.");
  }
  if (rows_ == 0) {
    return fail(ErrorCode::NoSamples, "The file has a header and no samples under it.");
  }
  if (!cells_.any_number()) {
    Error none = cells_.first_fault();
    none.message.pop_back();  // its full stop
    none.message += ", and no other cell is; wanted are numbers between commas, semicolons, tabs, bars or blanks.";
    return fail(std::move(none));
  }
  if (words_.count() > std::max<std::uint64_t>(3, rows_ / 10)) {
    line_ = words_.first();
    return at_line(ErrorCode::RaggedRow, "holds words alone, and so do " + std::to_string(words_.count() - 1) +
                                             " more between " + std::to_string(rows_) + " rows; is this one table?");
  }
  blank_.note(sink_, "blank line between the rows was skipped", "blank lines between the rows were skipped");
  words_.note(sink_, "line between the rows holds words alone and was skipped",
              "lines between the rows hold words alone and were skipped");
  if (torn_) {
    sink_.note("The file ends within a row (line " + std::to_string(line_) + "); that row is left out.");
  }
  if (inner_comments_ > 0) {
    sink_.note(with_count(inner_comments_, "comment line between the rows was skipped.",
                          "comment lines between the rows were skipped."));
  }
  cells_.note(rows_, sink_);
  return {};
}

/// True if a format of one kind of text takes it, or UBX, of which a short log looks like text: the table of numbers is
/// for what nobody else knows.
bool is_special(std::string_view head) {
  constexpr std::array kOfText{&kCxd5602, &kVmu931,    &kGeneactiv, &kEuroc, &kRostopic,
                               &kKfGins,  &kRtklibPos, &kNmea,      &kUbx};
  return std::any_of(kOfText.begin(), kOfText.end(), [head](const Format* format) { return format->sniff(head) > 0; });
}

int sniff(std::string_view head) {
  if (head.starts_with(text::kByteOrderMark)) {
    head.remove_prefix(text::kByteOrderMark.size());
  }
  const text::Shape shape = text::shape_of(head);
  if (shape == text::Shape::NotText || shape == text::Shape::LoneReturns || is_special(head)) {
    return 0;
  }
  if (shape != text::Shape::NotATable && shape != text::Shape::Spaces) {
    return 40;
  }
  const std::string_view start = text::trim(head);
  if (start.empty() || start.front() == '<' || start.front() == '{' || start.front() == '[') {
    return 0;
  }
  return text::find_dialect(head, head.size() < kSniffBytes).fraction_of_numbers > 0.5 ? 40 : 0;
}

Status decode(ByteSource& source, const DecodeLimits& limits, ColumnSink& sink, const RunControl& control) {
  ScalingSink in_units(sink);
  return CsvDecoder(source, limits, in_units, control).run();
}

}  // namespace

const Format kCsv{"csv", "a table of numbers in text, with or without a header row", sniff, decode};

}  // namespace driftlab::formats
