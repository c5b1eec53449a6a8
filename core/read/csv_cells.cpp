#include "core/read/csv_cells.hpp"

#include "core/read/decimal.hpp"
#include "core/read/text_shape.hpp"
#include "core/signal/missing.hpp"
#include "core/signal/with_count.hpp"

#include <cmath>
#include <utility>

namespace driftlab::formats {
namespace {

/// Why there is no number in a cell, as an error with its place.
Error fault_of(std::string_view cell, Missing why, const std::string& column, std::uint64_t line) {
  const bool word = why == Missing::Nan || why == Missing::Infinite;
  const std::string what = why == Missing::Empty        ? "the cell is empty."
                           : word                       ? text::excerpt(cell) + " is not a finite number."
                           : why == Missing::OutOfRange ? text::excerpt(cell) + " is larger than a double can hold."
                                                        : text::excerpt(cell) + " is not a number.";
  const ErrorCode code = word                         ? ErrorCode::NonFinite
                         : why == Missing::OutOfRange ? ErrorCode::OutOfRange
                                                      : ErrorCode::NotANumber;
  const std::string row = std::to_string(line);
  return {code, "Line " + row + ", column '" + column + "': " + what, {{"row", row}, {"column", column}}};
}

}  // namespace

CsvCells::CsvCells(ColumnNames names, bool decimal_comma, const std::vector<std::size_t>& clocks)
    : names_(std::move(names)), decimal_comma_(decimal_comma), texts_(names_.size()) {
  for (const std::size_t column : clocks) {
    clocks_.try_emplace(column);
  }
}

double CsvCells::time_in(std::string_view cell, Clock& clock, std::uint64_t line) {
  constexpr double kDay = 86400.0;
  const auto time_s = text::seconds_of_day(cell);
  if (!time_s) {
    return missing_sample(cell.empty() ? Missing::Empty : Missing::Text, line);
  }
  clock.days += *time_s < clock.last_s - 0.5 * kDay ? 1 : 0;
  clock.last_s = *time_s;
  return clock.days * kDay + *time_s;
}

double CsvCells::number_in(std::string_view cell, std::uint64_t line) const {
  if (cell.empty()) {
    return missing_sample(Missing::Empty, line);
  }
  if (text::is_non_finite_word(cell)) {
    const bool nan = (cell.back() | 0x20) == 'n';
    return missing_sample(nan ? Missing::Nan : Missing::Infinite, line);
  }
  const std::string terminated(cell);
  double value = 0.0;
  const char* const end =
      decimal_comma_ ? decimal::parse<','>(terminated.c_str(), value) : decimal::parse<'.'>(terminated.c_str(), value);
  if (end != terminated.c_str() + terminated.size()) {
    return text::seconds_of_date(cell).value_or(missing_sample(Missing::Text, line));
  }
  return std::isfinite(value) ? value : missing_sample(Missing::OutOfRange, line);
}

double CsvCells::take(std::string_view cell, std::size_t column, std::uint64_t line) {
  const auto clock = clocks_.find(column);
  const double value = clock == clocks_.end() ? number_in(cell, line) : time_in(cell, clock->second, line);
  if (!std::isnan(value)) {
    any_number_ = true;
    dates_ = dates_ || (clock == clocks_.end() && cell.size() > 10 &&
                        (cell.find(':') != std::string_view::npos || cell[8] == 'T'));
    return value;
  }
  const Missing why = why_missing(value).why;
  if (why == Missing::Text) {
    Texts& texts = texts_[column];
    texts.first = texts.count == 0 ? text::excerpt(cell) : texts.first;
    ++texts.count;
  }
  if (!any_number_ && first_fault_.message.empty()) {
    first_fault_ = fault_of(cell, why, names_[column], line);
  }
  return value;
}

void CsvCells::note(std::uint64_t rows, ColumnSink& sink) const {
  if (dates_) {
    sink.note("Dates are read as seconds since 1970-01-01 UTC.");
  }
  for (const auto& [column, clock] : clocks_) {
    sink.note("Times of day in column '" + names_[column] + "' are read as seconds since midnight" +
              (clock.days > 0 ? ", " + with_count(clock.days, "midnight") + " passed" : "") + ".");
  }
  for (std::size_t column = 0; column < texts_.size(); ++column) {
    if (texts_[column].count > 0) {
      sink.note("Column '" + names_[column] + "' holds text in " + std::to_string(texts_[column].count) + " of " +
                with_count(rows, "row") + ", first " + texts_[column].first + ".");
    }
  }
}

}  // namespace driftlab::formats
