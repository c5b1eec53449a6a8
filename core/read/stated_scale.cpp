#include "core/read/stated_scale.hpp"

#include "core/read/decimal.hpp"
#include "core/read/text_shape.hpp"
#include "core/signal/unit.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace driftlab {
namespace {

constexpr std::array<std::string_view, 8> kCounts{"LSB", "lsb", "LSb", "Lsb", "count", "counts", "digit", "digits"};

bool is_count(std::string_view word) { return std::find(kCounts.begin(), kCounts.end(), word) != kCounts.end(); }

/// `text` without the brackets around all of it.
std::string_view bare(std::string_view text) {
  text = text::trim(text);
  const bool inside = text.size() > 2 && text.front() == '(' && text.back() == ')';
  return inside ? text::trim(text.substr(1, text.size() - 2)) : text;
}

struct Scale {
  double counts_per_unit = 1.0;
  double units_per_count = 1.0;
  std::string_view unit;
};

/// The words of `131 LSB/(deg/s)` or `0.061 mg/LSB`.
std::optional<Scale> read_scale(std::string_view text) {
  const std::size_t digits = std::min(text.find_first_not_of("0123456789.+-eE"), text.size());
  const std::string number(text.substr(0, digits));
  double value = 0.0;
  if (number.empty() || decimal::parse(number.c_str(), value) != number.c_str() + number.size() ||
      !std::isfinite(value) || !std::isfinite(1.0 / value)) {
    return std::nullopt;
  }
  const std::string_view rest = text::trim(text.substr(digits));
  if (const std::size_t first = rest.find('/');
      first != std::string_view::npos && is_count(text::trim(rest.substr(0, first)))) {
    return Scale{value, 1.0, bare(rest.substr(first + 1))};
  }
  if (const std::size_t last = rest.rfind('/');
      last != std::string_view::npos && is_count(text::trim(rest.substr(last + 1)))) {
    return Scale{1.0, value, bare(rest.substr(0, last))};
  }
  return std::nullopt;
}

}  // namespace

std::optional<StatedScale> stated_scale(std::string_view name) {
  name = text::trim(name);
  if (name.empty() || (name.back() != ']' && name.back() != ')')) {
    return std::nullopt;
  }
  // The bracket that the last one closes: a unit may have brackets of its own.
  std::size_t open = name.size();
  int depth = 0;
  while (open > 0) {
    --open;
    const char c = name[open];
    depth += c == ')' || c == ']' ? 1 : c == '(' || c == '[' ? -1 : 0;
    if (depth == 0) {
      break;
    }
  }
  if (depth != 0) {
    return std::nullopt;
  }
  auto scale = read_scale(text::trim(name.substr(open + 1, name.size() - open - 2)));
  if (!scale) {
    return std::nullopt;
  }
  if (scale->unit == "mdps") {
    scale->unit = "deg/s";
    (scale->counts_per_unit != 1.0 ? scale->counts_per_unit : scale->units_per_count) *=
        scale->counts_per_unit != 1.0 ? 1e3 : 1e-3;
  }
  const auto unit = parse_unit(scale->unit);
  if (!unit || unit->dimension == Dimension::One) {
    return std::nullopt;
  }
  return StatedScale{std::string(text::trim(name.substr(0, open))) + " [" + unit->symbol + "]", scale->counts_per_unit,
                     scale->units_per_count};
}

Status ScalingSink::begin(const ColumnLayout& layout) {
  ColumnLayout scaled_layout = layout;
  bool any = false;
  for (std::string& name : scaled_layout.names) {
    auto scale = layout.has_header ? stated_scale(name) : std::nullopt;
    if (scale) {
      next_.note("Column '" + name + "' holds counts; the scale that its name states is applied.");
      name = scale->name;
      any = true;
    }
    scales_.push_back(std::move(scale));
  }
  if (!any) {
    scales_.clear();
  }
  return next_.begin(scaled_layout);
}

/// A missing sample stays as it is: what it says of itself survives no arithmetic.
double ScalingSink::scaled(std::size_t column, double value) const {
  const auto& scale = scales_[column];
  if (!scale || std::isnan(value)) {
    return value;
  }
  const double result = value / scale->counts_per_unit * scale->units_per_count;
  return std::isfinite(result) ? result : value;
}

Status ScalingSink::rows(std::span<const double> values) {
  if (scales_.empty()) {
    return next_.rows(values);
  }
  buffer_.resize(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    buffer_[i] = scaled(i % scales_.size(), values[i]);
  }
  return next_.rows(buffer_);
}

Status ScalingSink::column(std::size_t index, std::span<const double> values) {
  if (scales_.empty()) {
    return next_.column(index, values);
  }
  buffer_.resize(values.size());
  std::transform(values.begin(), values.end(), buffer_.begin(), [&](double value) { return scaled(index, value); });
  return next_.column(index, buffer_);
}

}  // namespace driftlab
