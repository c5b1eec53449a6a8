/// Any bytes as an uploaded file: sniffed, decompressed, decoded. Every answer is an error or a rectangular table of
/// finite numbers and missing samples, and the same whether the bytes arrive at once or in small pieces.
#include "core/read/format.hpp"
#include "core/read/text_shape.hpp"
#include "core/signal/missing.hpp"

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <vector>

namespace {

using namespace driftlab;

void require(bool holds) {
  if (!holds) {
    std::abort();
  }
}

class CheckingSink final : public ColumnSink {
 public:
  Status begin(const ColumnLayout& layout) override {
    require(counts_.empty() && !layout.names.empty());
    for (const std::string& name : layout.names) {
      require(text::to_utf8(name) == name);  // or no document could hold it
    }
    counts_.resize(layout.names.size());
    return {};
  }
  Status rows(std::span<const double> values) override {
    require(!values.empty() && values.size() % counts_.size() == 0);
    for (std::size_t i = 0; i < values.size(); ++i) {
      take(i % counts_.size(), values[i]);
    }
    return {};
  }
  Status column(std::size_t index, std::span<const double> values) override {
    require(index < counts_.size());
    for (const double value : values) {
      take(index, value);
    }
    return {};
  }
  void note(std::string sentence) override { require(text::to_utf8(sentence) == sentence); }

  void check(const Decoded& decoded) const {
    require(decoded.rows > 0 && decoded.names.size() == counts_.size());
    for (const std::size_t count : counts_) {
      require(count == decoded.rows);
    }
  }
  [[nodiscard]] double sum() const { return sum_; }

 private:
  void take(std::size_t index, double value) {
    ++counts_[index];
    if (std::isnan(value)) {  // a missing sample
      const MissingSample hole = why_missing(value);
      require(hole.why != Missing::Unknown);
      value = static_cast<double>(hole.row) + 0.1 * static_cast<double>(hole.why);
    }
    require(std::isfinite(value));
    sum_ = sum_ * 0.5 + value * 1e-300;  // bounded, and sensitive to value and order
  }

  std::vector<std::size_t> counts_;
  double sum_ = 0.0;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  DecodeLimits limits;
  limits.expansion_allowance = std::uint64_t{4} << 20;  // a bomb ends before the fuzzer's patience
  limits.expansion_ratio = 0;
  limits.max_decoder_memory = std::uint64_t{64} << 20;
  CheckingSink whole;
  CheckingSink pieces;
  const auto first = decode_stream(make_memory_reader(bytes), whole, limits);
  const auto second = decode_stream(make_memory_reader(bytes, 13), pieces, limits);
  require(first.has_value() == second.has_value());
  if (!first) {
    require(first.error().code == second.error().code && first.error().message == second.error().message);
    require(!first.error().message.empty() && first.error().code != ErrorCode::Internal);
    require(text::to_utf8(first.error().message) == first.error().message);
    return 0;
  }
  whole.check(*first);
  pieces.check(*second);
  require(whole.sum() == pieces.sum() && first->names == second->names && first->notes == second->notes);
  return 0;
}
