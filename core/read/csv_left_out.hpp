#pragma once
/// Lines inside a text table that are no rows: what a logger prints between its samples. They are left out, counted and
/// said. Internal to core/read.
#include "core/read/format.hpp"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace driftlab::formats {

/// Lines of one kind that were left out: how many, and where the first stands.
class CsvLeftOut {
 public:
  /// `count` lines from `line` on; `text` of the first is shown, at most 40 bytes of it.
  void add(std::uint64_t line, std::uint64_t count, std::string_view text);
  [[nodiscard]] std::uint64_t count() const { return count_; }
  [[nodiscard]] std::uint64_t first() const { return first_; }
  /// `3 <several> (the first is line 502: "[WARN] buffer full").`, `1 <one> (line 502: ...).`; nothing where there are
  /// none.
  void note(ColumnSink& sink, std::string_view one, std::string_view several) const;

 private:
  std::uint64_t count_ = 0;
  std::uint64_t first_ = 0;
  std::string text_;
};

/// True for a line that a logger prints between rows: the names once more, or cells that are fewer or more than a row's
/// and none of which is a number or empty. A row of words of the right width is a row with missing samples.
[[nodiscard]] bool is_interruption(const std::vector<std::string>& cells, const ColumnNames& names, bool decimal_comma);

}  // namespace driftlab::formats
