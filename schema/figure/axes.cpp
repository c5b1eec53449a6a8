#include "schema/figure/axes.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

namespace driftlab::figure {

Axis ratio_axis(std::string name, double limit) {
  return {ScaleKind::Log, std::move(name), std::pair{1.0 / limit, limit}};
}

std::vector<double> ratio_ticks(double limit, bool finer) {
  if (limit > 2.2) {
    return {0.5, 1.0, 2.0};
  }
  if (limit > 1.6) {
    return {0.67, 1.0, 1.5};
  }
  return finer ? std::vector{0.8, 0.9, 1.0, 1.1, 1.25} : std::vector{0.8, 1.0, 1.25};
}

Axis places_axis(std::string name, std::size_t count) {
  Axis axis{ScaleKind::Linear, std::move(name), std::pair{0.4, static_cast<double>(count) + 0.6}};
  for (std::size_t i = 1; i <= count; ++i) {
    axis.ticks.push_back(static_cast<double>(i));
  }
  return axis;
}

double beside(double place, std::size_t index, std::size_t count) {
  const auto members = static_cast<double>(std::max<std::size_t>(1, count));
  return place + (static_cast<double>(index) / members - 0.5 + 0.5 / members) * 0.5;
}

Axis axis_about_zero(std::string name, double greatest) {
  const double far = std::max(1e-9, greatest);
  return {ScaleKind::Linear, std::move(name), std::pair{-far * 0.04, far * 1.06}};
}

Axis axis_from_zero(std::string name, double greatest) {
  return {ScaleKind::Linear, std::move(name), std::pair{0.0, greatest * 1.12}};
}

void frame_by_curves(Plot& plot) {
  constexpr double kRoom = 1.5;
  double least = std::numeric_limits<double>::infinity();
  double most = 0.0;
  for (const Series& series : plot.series) {
    for (const auto& y : series.y) {
      if (y && *y > 0.0) {
        least = std::min(least, *y);
        most = std::max(most, *y);
      }
    }
  }
  if (most > 0.0) {
    plot.y.domain = {least / kRoom, most * kRoom};
  }
}

void frame_as_map(Plot& plot) {
  constexpr double kMargin = 0.04;
  constexpr double kFlattest = 0.4;
  std::array<double, 4> ends{1e300, -1e300, 1e300, -1e300};
  for (const Series& series : plot.series) {
    for (std::size_t i = 0; i < series.x.size(); ++i) {
      if (const auto& y = series.y[i]) {
        ends = {std::min(ends[0], series.x[i]), std::max(ends[1], series.x[i]), std::min(ends[2], *y),
                std::max(ends[3], *y)};
      }
    }
  }
  if (ends[0] > ends[1]) {
    return;
  }
  const double margin = kMargin * std::max({ends[1] - ends[0], ends[3] - ends[2], 1.0});
  double wide = ends[1] - ends[0] + 2.0 * margin;
  double high = ends[3] - ends[2] + 2.0 * margin;
  wide = std::max(wide, high);
  high = std::max(high, kFlattest * wide);
  const double middle_x = 0.5 * (ends[0] + ends[1]);
  const double middle_y = 0.5 * (ends[2] + ends[3]);
  plot.x.domain = {middle_x - 0.5 * wide, middle_x + 0.5 * wide};
  plot.y.domain = {middle_y - 0.5 * high, middle_y + 0.5 * high};
  plot.equal_units = true;
}

double greatest_of(const Series& series) {
  double most = 0.0;
  for (std::size_t i = 0; i < series.y.size(); ++i) {
    const auto& end = i < series.high.size() ? series.high[i] : std::nullopt;
    most = std::max({most, series.y[i].value_or(0.0), end.value_or(0.0)});
  }
  return most;
}

double farthest_of(const Series& series) { return *std::max_element(series.x.begin(), series.x.end()); }

}  // namespace driftlab::figure
