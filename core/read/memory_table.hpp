#pragma once
/// Tables of a file that holds several, in memory until it is known which of them make the recording. Internal to
/// core/read.
#include "core/read/format.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace driftlab {

/// Columns of equal length.
struct MemoryTable {
  std::string name;  ///< of the file or variable it comes from
  ColumnNames names;
  std::vector<std::vector<double>> columns;
  std::vector<std::string> notes;

  [[nodiscard]] std::size_t rows() const { return columns.empty() ? 0 : columns.front().size(); }
};

/// Stores the rows that a decoder delivers in a table. Error: LimitExceeded above `budget_bytes`, which several sinks
/// may share.
class MemorySink final : public ColumnSink {
 public:
  MemorySink(MemoryTable& table, std::size_t& budget_bytes) : table_(table), budget_bytes_(budget_bytes) {}
  [[nodiscard]] Status begin(const ColumnLayout& layout) override;
  [[nodiscard]] Status rows(std::span<const double> values) override;
  [[nodiscard]] Status column(std::size_t index, std::span<const double> values) override;
  void note(std::string sentence) override { table_.notes.push_back(std::move(sentence)); }

 private:
  [[nodiscard]] Status spend(std::size_t values);
  MemoryTable& table_;
  std::size_t& budget_bytes_;
};

/// The columns that make the recording, of one length, and the rate that the file states, if it does.
struct Recorded {
  ColumnNames names;
  std::vector<std::span<const double>> columns;
  std::optional<double> rate_hz;
};

/// Delivers the columns of a recording. If a rate is stated and no column is a time, a time column made from the rate
/// is added.
[[nodiscard]] Status deliver(const Recorded& recorded, const DecodeLimits& limits, ColumnSink& sink);

}  // namespace driftlab
