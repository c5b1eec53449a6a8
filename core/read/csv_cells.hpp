#pragma once
/// The slow path of the CSV reader, which reads one cell of any content. Internal to core/read.
#include "core/read/format.hpp"
#include "core/signal/result.hpp"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace driftlab::formats {

/// Reads cells and remembers what in them is no number.
class CsvCells {
 public:
  CsvCells() = default;
  CsvCells(ColumnNames names, bool decimal_comma);

  /// The number that is all of `cell`, a date as seconds since 1970, or a NaN that says why there is none. `line`
  /// counts from 1.
  double take(std::string_view cell, std::size_t column, std::uint64_t line);

  /// A number was met, here or by the fast reader.
  [[nodiscard]] bool any_number() const { return any_number_; }
  void number_met() { any_number_ = true; }
  /// The first cell that is no number; the answer where there is no number at all.
  [[nodiscard]] const Error& first_fault() const { return first_fault_; }
  /// Says which columns hold dates or text.
  void note(std::uint64_t rows, ColumnSink& sink) const;

 private:
  /// What was met in one column that is no number.
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
