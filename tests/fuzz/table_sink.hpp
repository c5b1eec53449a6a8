#pragma once
/// What fuzz targets of decoding share: a requirement whose failure is a finding, and a sink that requires a table.
#include "core/read/format.hpp"

#include <cstdlib>

namespace driftlab {

inline void require(bool holds) {
  if (!holds) {
    std::abort();
  }
}

/// Requires one beginning, whole rows, and columns that were announced.
class TableSink : public ColumnSink {
 public:
  Status begin(const ColumnLayout& layout) override {
    require(width_ == 0 && !layout.names.empty());
    width_ = layout.names.size();
    return {};
  }
  Status rows(std::span<const double> values) override {
    require(width_ > 0 && values.size() % width_ == 0);
    return {};
  }
  Status column(std::size_t index, std::span<const double>) override {
    require(index < width_);
    return {};
  }

 private:
  std::size_t width_ = 0;
};

}  // namespace driftlab
