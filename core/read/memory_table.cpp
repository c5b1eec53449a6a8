#include "core/read/memory_table.hpp"

#include "core/read/csv_time.hpp"

#include <algorithm>

namespace driftlab {

Status MemorySink::begin(const ColumnLayout& layout) {
  table_.names = layout.names;
  table_.columns.resize(layout.names.size());
  return {};
}

Status MemorySink::spend(std::size_t values) {
  if (values * sizeof(double) > budget_bytes_) {
    return fail(ErrorCode::LimitExceeded,
                "The file holds more samples in several tables than can be put together; send its tables one by one.");
  }
  budget_bytes_ -= values * sizeof(double);
  return {};
}

Status MemorySink::rows(std::span<const double> values) {
  if (auto status = spend(values.size()); !status) {
    return status;
  }
  const std::size_t width = table_.columns.size();
  for (std::size_t i = 0; i < values.size(); ++i) {
    table_.columns[i % width].push_back(values[i]);
  }
  return {};
}

Status MemorySink::column(std::size_t index, std::span<const double> values) {
  if (auto status = spend(values.size()); !status) {
    return status;
  }
  table_.columns[index].insert(table_.columns[index].end(), values.begin(), values.end());
  return {};
}

Status deliver(const Recorded& recorded, const DecodeLimits& limits, ColumnSink& sink) {
  if (recorded.columns.size() > limits.max_columns) {
    return fail(ErrorCode::LimitExceeded, "The file has " + std::to_string(recorded.columns.size()) +
                                              " columns; at most " + std::to_string(limits.max_columns) + " are read.");
  }
  for (const std::string& name : recorded.names) {
    if (name.size() > limits.max_name_bytes) {
      return fail(ErrorCode::LimitExceeded,
                  "A column name is longer than " + std::to_string(limits.max_name_bytes) + " bytes.");
    }
  }
  ColumnLayout layout{recorded.names, true};
  TimeFromRate time;
  if (recorded.rate_hz) {
    time = TimeFromRate(recorded.names, *recorded.rate_hz);
    sink.note(time.sentence());
  }
  if (time.needed()) {
    layout.names.emplace_back(TimeFromRate::kName);
  }
  if (auto status = sink.begin(layout); !status) {
    return status;
  }
  for (std::size_t i = 0; i < recorded.columns.size(); ++i) {
    if (auto status = sink.column(i, recorded.columns[i]); !status) {
      return status;
    }
  }
  if (!time.needed()) {
    return {};
  }
  const std::size_t rows = recorded.columns.front().size();
  std::vector<double> stamps(rows);
  std::vector<double> row(recorded.columns.size());
  for (std::size_t i = 0; i < rows; ++i) {
    std::transform(recorded.columns.begin(), recorded.columns.end(), row.begin(),
                   [i](std::span<const double> column) { return column[i]; });
    stamps[i] = time.at(i, row.data());
  }
  return sink.column(recorded.columns.size(), stamps);
}

}  // namespace driftlab
