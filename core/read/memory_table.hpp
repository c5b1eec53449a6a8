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

/// Keeps what a decoder delivers. Error: LimitExceeded above `budget_bytes`, which several sinks may share.
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

/// Columns that go together, of one length, and a rate stated beside them.
struct Recorded {
  ColumnNames names;
  std::vector<std::span<const double>> columns;
  std::optional<double> rate_hz;
};

/// Delivers a recording: its columns, and where none of them is a time and a rate is stated the time made from that.
[[nodiscard]] Status deliver(const Recorded& recorded, const DecodeLimits& limits, ColumnSink& sink);

}  // namespace driftlab
