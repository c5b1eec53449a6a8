#include "schema/figure/layout.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>

namespace driftlab::figure {
namespace {

constexpr double kLeft = 58.0;
constexpr double kKey = 152.0;
constexpr double kNarrow = 600.0;
constexpr double kLeastEqual = 240.0;
constexpr double kMostEqual = 900.0;
constexpr double kKeyLine = 18.0;
constexpr double kKeyColumn = 190.0;

using Range = std::pair<double, double>;
using Values = std::vector<std::optional<double>>;

/// Range of what can be drawn; grows with `add`.
class Extent {
 public:
  explicit Extent(bool log) : log_(log) {}
  void add(double value) {
    if (std::isfinite(value) && (!log_ || value > 0.0)) {
      low_ = std::min(low_, value);
      high_ = std::max(high_, value);
    }
  }
  [[nodiscard]] Range range() const {
    if (!(low_ <= high_)) {
      return log_ ? Range{0.1, 10.0} : Range{0.0, 1.0};
    }
    if (low_ == high_) {
      return log_ ? Range{low_ / 2.0, high_ * 2.0} : Range{low_ - 1.0, high_ + 1.0};
    }
    return {low_, high_};
  }

 private:
  bool log_;
  double low_ = std::numeric_limits<double>::infinity();
  double high_ = -std::numeric_limits<double>::infinity();
};

Range padded(Range range, bool log, double share) {
  if (log) {
    const double more = std::pow(range.second / range.first, share);
    return {range.first / more, range.second * more};
  }
  const double more = (range.second - range.first) * share;
  return {range.first - more, range.second + more};
}

bool any_points(const std::vector<Series>& series) {
  return std::any_of(series.begin(), series.end(), [](const Series& one) { return one.mark != Mark::None; });
}

/// Curves follow the points, not the other way round.
Range domain_x(const std::vector<Plot>& plots) {
  const Axis& axis = plots.front().x;
  if (axis.domain) {
    return *axis.domain;
  }
  const bool log = axis.scale == ScaleKind::Log;
  const bool points = std::any_of(plots.begin(), plots.end(), [](const Plot& plot) { return any_points(plot.series); });
  Extent extent(log);
  for (const Plot& plot : plots) {
    for (const Series& one : plot.series) {
      if (!points || one.mark != Mark::None) {
        std::for_each(one.x.begin(), one.x.end(), [&](double x) { extent.add(x); });
      }
    }
  }
  return padded(extent.range(), log, 0.03);
}

void add_inside(const Series& one, const Values& values, const Range& x, Extent& extent) {
  for (std::size_t i = 0; i < values.size() && i < one.x.size(); ++i) {
    const auto& value = values[i];
    if (value && one.x[i] >= x.first && one.x[i] <= x.second) {
      extent.add(*value);
    }
  }
}

Range domain_y(const Plot& plot, const Range& x) {
  if (plot.y.domain) {
    return *plot.y.domain;
  }
  const bool log = plot.y.scale == ScaleKind::Log;
  const bool points = any_points(plot.series);
  Extent body(log);
  Extent ends(log);
  for (const Series& one : plot.series) {
    if (!points || one.mark != Mark::None) {
      add_inside(one, one.y, x, body);
    }
    add_inside(one, one.y, x, ends);
    add_inside(one, one.low, x, ends);
    add_inside(one, one.high, x, ends);
  }
  // The last intervals may reach far: what lies nearly a decade outside the points is cut.
  const Range inner = body.range();
  const Range outer = ends.range();
  const Range range =
      log ? Range{std::max(outer.first, inner.first / 8.0), std::min(outer.second, inner.second * 8.0)} : outer;
  return padded(range, log, 0.05);
}

void add_log_ticks(Scale& scale) {
  const double decades = std::log10(scale.high / scale.low);
  const int every = decades > 9.0 ? 2 : 1;
  const auto labelled = [&](int digit) {
    return digit == 1 || (decades < 2.2 && (digit == 2 || digit == 5)) || (decades < 1.3 && digit == 3);
  };
  for (int e = static_cast<int>(std::floor(std::log10(scale.low)));
       e <= static_cast<int>(std::ceil(std::log10(scale.high))); ++e) {
    for (int digit = 1; digit < 10; ++digit) {
      const double value = digit * std::pow(10.0, e);
      if (value < scale.low * (1.0 - 1e-9) || value > scale.high * (1.0 + 1e-9)) {
        continue;
      }
      const bool shown = labelled(digit) && (digit > 1 || e % every == 0);
      (shown ? scale.ticks : scale.minor).push_back(value);
    }
  }
}

/// Steps of 1, 2 or 5 times a power of ten, about `count` of them.
void add_linear_ticks(Scale& scale, double count) {
  const double span = scale.high - scale.low;
  const double raw = span / std::max(2.0, std::round(count));
  const double power = std::pow(10.0, std::floor(std::log10(raw)));
  const double error = raw / power;
  const double step = power * (error >= std::sqrt(50.0)   ? 10.0
                               : error >= std::sqrt(10.0) ? 5.0
                               : error >= std::sqrt(2.0)  ? 2.0
                                                          : 1.0);
  for (double k = std::ceil(scale.low / step); k <= std::floor(scale.high / step); k += 1.0) {
    scale.ticks.push_back(k * step);
  }
}

Scale make_scale(const Axis& axis, const Range& domain, double from, double to) {
  Scale scale{axis.scale, domain.first, domain.second, from, to, axis.ticks, {}};
  if (!axis.ticks.empty() || axis.bare) {
    return scale;
  }
  if (axis.scale == ScaleKind::Log) {
    add_log_ticks(scale);
  } else {
    add_linear_ticks(scale, std::abs(to - from) / (from < to ? 90.0 : 44.0));
  }
  return scale;
}

/// Height of a plot whose metres are equal; its y domain is widened or narrowed to the heights allowed.
double equal_height_of_linear(const Range& x, double width, Range& y) {
  const double per_unit = width / (x.second - x.first);
  const double height = per_unit * (y.second - y.first);
  const double wanted = std::clamp(height, kLeastEqual, kMostEqual);
  const double more = (wanted - height) / per_unit / 2.0;
  y.first -= more;
  y.second += more;
  return wanted;
}

/// The same of decades.
double equal_height(const Range& x, double width, Range& y) {
  const double per_decade = width / std::log10(x.second / x.first);
  const double height = per_decade * std::log10(y.second / y.first);
  const double wanted = std::clamp(height, kLeastEqual, kMostEqual);
  const double more = std::pow(10.0, (wanted - height) / per_decade / 2.0);
  y.first /= more;
  y.second *= more;
  return wanted;
}

std::string superscript(int number) {
  static constexpr std::array<const char*, 10> kDigits{"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string text = number < 0 ? "⁻" : "";
  for (const char digit : std::to_string(std::abs(number))) {
    text += kDigits[static_cast<std::size_t>(digit - '0')];
  }
  return text;
}

}  // namespace

double Scale::at(double value) const {
  const double share = kind == ScaleKind::Log ? (std::log(value) - std::log(low)) / (std::log(high) - std::log(low))
                                              : (value - low) / (high - low);
  return from + (to - from) * share;
}

Layout layout(const std::vector<Plot>& plots, double width) {
  std::size_t keys = 0;
  for (const Plot& plot : plots) {
    keys += static_cast<std::size_t>(
        std::count_if(plot.series.begin(), plot.series.end(), [](const Series& one) { return one.key; }));
  }
  Layout plan;
  plan.width = width;
  plan.key_below = width < kNarrow || keys == 0;
  plan.key_left = width - kKey + 14.0;
  const double right = plan.key_below ? width - 8.0 : width - kKey;
  const Range x = domain_x(plots);
  double top = 0.0;
  for (const Plot& plot : plots) {
    Range y = domain_y(plot, x);
    const bool linear = plot.x.scale == ScaleKind::Linear;
    const double height = !plot.equal_units ? plot.height
                          : linear          ? equal_height_of_linear(x, right - kLeft, y)
                                            : equal_height(x, right - kLeft, y);
    Area area;
    area.plot = &plot;
    area.left = kLeft;
    area.right = right;
    area.top = top + (plot.y.name.empty() ? 10.0 : 32.0);
    area.bottom = area.top + height;
    area.foot = area.bottom + (plot.hide_x ? 12.0 : plot.x.name.empty() ? 26.0 : 44.0);
    area.x = make_scale(plot.x, x, kLeft, right);
    area.y = make_scale(plot.y, y, area.bottom, area.top);
    top = area.foot;
    plan.areas.push_back(std::move(area));
  }
  const double columns = std::max(1.0, std::floor(width / kKeyColumn));
  plan.height =
      top + (plan.key_below && keys > 0 ? std::ceil(static_cast<double>(keys) / columns) * kKeyLine + 6.0 : 0.0);
  return plan;
}

std::string tick_text(double value) {
  if (value == 0.0) {
    return "0";
  }
  const double exact = std::log10(std::abs(value));
  const double e = std::round(exact * 1e9) / 1e9;
  if (e == std::round(e) && (e >= 5.0 || e < -3.0)) {
    return "10" + superscript(static_cast<int>(e));
  }
  std::array<char, 48> buffer{};
  if (std::abs(value) < 1e-3 || std::abs(value) >= 1e6) {
    const int power = static_cast<int>(std::floor(exact));
    (void)std::snprintf(buffer.data(), buffer.size(), "%.2g × 10", value / std::pow(10.0, power));
    return buffer.data() + superscript(power);
  }
  const int decimals = std::clamp(3 - static_cast<int>(std::floor(exact)), 0, 6);
  (void)std::snprintf(buffer.data(), buffer.size(), "%.*f", decimals, std::abs(value));
  std::string text = buffer.data();
  if (text.find('.') != std::string::npos) {
    text.erase(text.find_last_not_of('0') + 1);
    text.erase(text.find_last_not_of('.') + 1);
  }
  return (value < 0.0 ? "−" : "") + text;
}

}  // namespace driftlab::figure
