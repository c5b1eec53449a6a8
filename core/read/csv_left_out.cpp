#include "core/read/csv_left_out.hpp"

#include "core/read/dialect.hpp"
#include "core/read/text_shape.hpp"
#include "core/signal/with_count.hpp"

#include <algorithm>

namespace driftlab::formats {

void CsvLeftOut::add(std::uint64_t line, std::uint64_t count, std::string_view text) {
  if (count_ == 0) {
    first_ = line;
    constexpr std::size_t kShown = 40;
    for (const char c : text::trim(text).substr(0, kShown)) {
      text_ += c >= ' ' && c <= '~' ? c : '?';
    }
  }
  count_ += count;
}

void CsvLeftOut::note(ColumnSink& sink, std::string_view one, std::string_view several) const {
  if (count_ > 0) {
    sink.note(with_count(count_, one, several) + (count_ == 1 ? " (line " : " (the first is line ") +
              std::to_string(first_) + (text_.empty() ? "" : ": \"" + text_ + "\"") + ").");
  }
}

bool is_interruption(const std::vector<std::string>& cells, const ColumnNames& names, bool decimal_comma) {
  if (cells.size() == names.size()) {
    return cells.size() > 1 && std::equal(cells.begin(), cells.end(), names.begin());
  }
  return std::none_of(cells.begin(), cells.end(),
                      [&](const std::string& cell) { return cell.empty() || text::is_number(cell, decimal_comma); });
}

}  // namespace driftlab::formats
