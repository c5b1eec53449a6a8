#pragma once
/// Raw counts whose scale the name of the column states, in quantities. Internal to core/read.
///
/// Loggers of bare sensors write what the registers hold, and say in the head of the table what a step is, in one of
/// two ways: `gx [131 LSB/(deg/s)]`, as data sheets write it, or `gx [0.061 mg/LSB]`. Such a column is delivered in
/// that unit, `gx [deg/s]`, with a note; every other column passes unchanged. A scale that is zero or not finite, and a
/// unit that driftlab does not know, are left for whoever reads the name.
#include "core/read/format.hpp"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace driftlab {

/// What the end of a name in brackets states about counts.
struct StatedScale {
  std::string name;            ///< of the column in the unit: `gx [deg/s]`
  double counts_per_unit = 1;  ///< divides the counts, where the scale is stated so; else 1
  double units_per_count = 1;  ///< multiplies them, where the scale is stated so; else 1
};

/// `mdps` is 0.001 deg/s; `LSB`, `count` and `digit` mean the same. Nothing where the name states no scale.
[[nodiscard]] std::optional<StatedScale> stated_scale(std::string_view name);

/// Passes on to another sink, columns of counts in their stated units.
class ScalingSink final : public ColumnSink {
 public:
  explicit ScalingSink(ColumnSink& next) : next_(next) {}

  [[nodiscard]] Status begin(const ColumnLayout& layout) override;
  [[nodiscard]] Status rows(std::span<const double> values) override;
  [[nodiscard]] Status column(std::size_t index, std::span<const double> values) override;
  void note(std::string sentence) override { next_.note(std::move(sentence)); }

 private:
  [[nodiscard]] double scaled(std::size_t column, double value) const;

  ColumnSink& next_;
  std::vector<std::optional<StatedScale>> scales_;  ///< by column; empty where none is stated
  std::vector<double> buffer_;
};

}  // namespace driftlab
