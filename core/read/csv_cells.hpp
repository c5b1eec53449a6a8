#pragma once
/// The slow path of the CSV reader: it reads a cell that may hold a number, a date or text. Internal to core/read.
#include "core/read/format.hpp"
#include "core/signal/result.hpp"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace driftlab::formats {

/// Reads cells, and remembers which columns held dates or text.
class CsvCells {
 public:
  CsvCells() = default;
  CsvCells(ColumnNames names, bool decimal_comma);

  /// The number in `cell` if the cell holds nothing else, a date as seconds since 1970, or otherwise a NaN that encodes
  /// the reason (core/signal/missing.hpp). `line` counts from 1.
  double take(std::string_view cell, std::size_t column, std::uint64_t line);

  /// Whether any cell held a number, here or in the fast reader, which reports it by `number_met`.
  [[nodiscard]] bool any_number() const { return any_number_; }
  void number_met() { any_number_ = true; }
  /// The error of the first cell without a number; it is the error of a file that holds no number at all.
  [[nodiscard]] const Error& first_fault() const { return first_fault_; }
  /// Says which columns hold dates or text.
  void note(std::uint64_t rows, ColumnSink& sink) const;

 private:
  /// Cells of one column that hold text.
  struct Texts {
    std::uint64_t count = 0;
    std::string first;  ///< an excerpt in quotes
  };
  [[nodiscard]] double number_in(std::string_view cell, std::uint64_t line) const;

  ColumnNames names_;
  bool decimal_comma_ = false;
  bool any_number_ = false;
  bool dates_ = false;
  std::vector<Texts> texts_;
  Error first_fault_;
};

}  // namespace driftlab::formats
