#pragma once
/// Where things go: scales, margins and ticks of a column of plots. The same arithmetic as the pages' layout.ts, so
/// that one document gives one drawing.
#include "schema/figure/plot.hpp"

namespace driftlab::figure {

struct Scale {
  ScaleKind kind = ScaleKind::Log;
  double low = 0.1;  ///< domain
  double high = 10.0;
  double from = 0.0;  ///< pixels of its ends
  double to = 1.0;
  std::vector<double> ticks;
  std::vector<double> minor;

  [[nodiscard]] double at(double value) const;
};

struct Area {
  const Plot* plot = nullptr;
  Scale x;
  Scale y;
  double left = 0.0, right = 0.0, top = 0.0, bottom = 0.0;
  double foot = 0.0;  ///< lowest pixel that belongs to it
};

struct Layout {
  double width = 0.0;
  double height = 0.0;
  std::vector<Area> areas;
  bool key_below = false;
  double key_left = 0.0;
};

/// `plots` must outlive the layout and not be empty. `width` in pixels.
[[nodiscard]] Layout layout(const std::vector<Plot>& plots, double width);

/// A tick as it is written: short, powers of ten from 10^5 and below 10^-3.
[[nodiscard]] std::string tick_text(double value);

}  // namespace driftlab::figure
