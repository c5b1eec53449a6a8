#pragma once
/// The slow path of the CSV reader: it reads a cell that may hold a number, a date or text. Internal to core/read.
#include "core/read/format.hpp"
#include "core/signal/result.hpp"

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace driftlab::formats {

/// Reads cells, and remembers which columns held dates, times of day or text.
class CsvCells {
 public:
  CsvCells() = default;
  /// `clocks`: columns of times of day.
  CsvCells(ColumnNames names, bool decimal_comma, const std::vector<std::size_t>& clocks);

  /// The number in `cell` if the cell holds nothing else, a date as seconds since 1970, in a column of times of day the
  /// seconds since the first midnight (a clock that falls by more than half a day has passed another), or otherwise a
  /// NaN that encodes the reason (core/signal/missing.hpp). `line` counts from 1.
  double take(std::string_view cell, std::size_t column, std::uint64_t line);

  /// Whether any cell held a number, here or in the fast reader, which reports it by `number_met`.
  [[nodiscard]] bool any_number() const { return any_number_; }
  void number_met() { any_number_ = true; }
  /// The error of the first cell without a number; it is the error of a file that holds no number at all.
  [[nodiscard]] const Error& first_fault() const { return first_fault_; }
  /// Says which columns hold dates, times of day or text.
  void note(std::uint64_t rows, ColumnSink& sink) const;

 private:
  /// Cells of one column that hold text.
  struct Texts {
    std::uint64_t count = 0;
    std::string first;  ///< an excerpt in quotes
  };
  /// A column of times of day.
  struct Clock {
    double last_s = 0.0;  ///< since midnight
    int days = 0;         ///< midnights passed
  };
  [[nodiscard]] double number_in(std::string_view cell, std::uint64_t line) const;
  [[nodiscard]] static double time_in(std::string_view cell, Clock& clock, std::uint64_t line);

  ColumnNames names_;
  bool decimal_comma_ = false;
  bool any_number_ = false;
  bool dates_ = false;
  std::vector<Texts> texts_;
  std::map<std::size_t, Clock> clocks_;
  Error first_fault_;
};

}  // namespace driftlab::formats
