#pragma once
/// Where a decoder's values go while its speed is measured.
#include "core/read/format.hpp"

#include <benchmark/benchmark.h>

#include <cstddef>
#include <span>
#include <string>

namespace driftlab::testing {

/// Takes every value and keeps none.
class DroppingSink final : public ColumnSink {
 public:
  Status begin(const ColumnLayout&) override { return {}; }
  Status rows(std::span<const double> values) override {
    benchmark::DoNotOptimize(values.data());
    return {};
  }
  Status column(std::size_t, std::span<const double> values) override {
    benchmark::DoNotOptimize(values.data());
    return {};
  }
  void note(std::string) override {}
};

}  // namespace driftlab::testing
