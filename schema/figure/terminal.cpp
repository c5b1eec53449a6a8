#include "schema/figure/drawing.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace driftlab::figure {
namespace {

constexpr std::size_t kRows = 20;
constexpr std::size_t kMargin = 9;  ///< columns left of the axis

/// Characters on a screen: a code point takes one column.
std::size_t columns_of(const std::string& text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
}

std::string cut(const std::string& text, std::size_t columns) {
  std::string out;
  for (const char c : text) {
    if ((static_cast<unsigned char>(c) & 0xC0U) != 0x80U && columns_of(out) == columns) {
      break;
    }
    out += c;
  }
  return out;
}

/// Dots of two by four in each character (Unicode 2800 to 28FF).
class Dots {
 public:
  Dots(std::size_t columns, std::size_t rows) : columns_(columns), cells_(columns * rows, 0), rows_(rows) {}
  [[nodiscard]] double width() const { return static_cast<double>(2 * columns_ - 1); }
  [[nodiscard]] double height() const { return static_cast<double>(4 * rows_ - 1); }

  void set(double x, double y) {
    if (!(x >= 0.0 && y >= 0.0 && x <= width() && y <= height())) {
      return;
    }
    constexpr std::array<std::array<std::uint8_t, 2>, 4> kBits{{{1, 8}, {2, 16}, {4, 32}, {64, 128}}};
    const auto column = static_cast<std::size_t>(std::lround(x));
    const auto row = static_cast<std::size_t>(std::lround(y));
    cells_[(row / 4) * columns_ + column / 2] |= kBits[row % 4][column % 2];
  }

  void line(Point a, Point b) {
    const double steps = std::max({1.0, std::abs(b.x - a.x), std::abs(b.y - a.y)});
    for (double i = 0.0; i <= steps; i += 1.0) {
      set(a.x + (b.x - a.x) * i / steps, a.y + (b.y - a.y) * i / steps);
    }
  }

  [[nodiscard]] std::string row(std::size_t index) const {
    std::string text;
    for (std::size_t column = 0; column < columns_; ++column) {
      const unsigned code = 0x2800U + cells_[index * columns_ + column];
      text += static_cast<char>(0xE0U | (code >> 12U));
      text += static_cast<char>(0x80U | ((code >> 6U) & 0x3FU));
      text += static_cast<char>(0x80U | (code & 0x3FU));
    }
    return text;
  }

 private:
  std::size_t columns_;
  std::vector<std::uint8_t> cells_;
  std::size_t rows_;
};

/// Cells of a quarter of the full colour and more; whether they are above or below is not to be seen.
void plot_cells(const Area& area, Dots& dots) {
  constexpr double kSeen = 0.25;
  const Cells& cells = area.plot->cells;
  const auto at = [](double pixel, double from, double to, double size) { return (pixel - from) * size / (to - from); };
  for (std::size_t i = 0; i < cells.x.size(); ++i) {
    for (std::size_t k = 0; k < cells.y.size() && i * cells.y.size() + k < cells.values.size(); ++k) {
      if (std::abs(cells.values[i * cells.y.size() + k]) >= kSeen) {
        dots.set(at(area.x.at(cells.x[i]), area.left, area.right, dots.width()),
                 at(area.y.at(cells.y[k]), area.top, area.bottom, dots.height()));
      }
    }
  }
}

/// The measured series as points of two by two dots with their intervals, models as lines; components stay away.
void plot_series(const Area& area, Dots& dots) {
  const double wide = dots.width() / (area.right - area.left);
  const double high = dots.height() / (area.bottom - area.top);
  const auto place = [&](double x, double y) {
    return Point{(area.x.at(x) - area.left) * wide, (area.y.at(y) - area.top) * high};
  };
  for (const Series& series : area.plot->series) {
    Point before;
    bool joined = false;
    for (std::size_t i = 0; i < series.x.size() && i < series.y.size(); ++i) {
      const auto value = series.y[i];
      if (!value || (area.plot->y.scale == ScaleKind::Log && !(*value > 0.0))) {
        joined = false;
        continue;
      }
      const Point at = place(series.x[i], *value);
      if (series.mark != Mark::None) {
        dots.set(at.x, at.y);
        dots.set(at.x + 1.0, at.y);
        dots.set(at.x, at.y + 1.0);
        dots.set(at.x + 1.0, at.y + 1.0);
        if (i < series.low.size() && i < series.high.size() && series.low[i] && series.high[i] &&
            *series.low[i] > 0.0) {
          dots.line(place(series.x[i], *series.low[i]), place(series.x[i], *series.high[i]));
        }
      } else if (series.line && series.dash.empty() && joined) {
        dots.line(before, at);
      }
      before = at;
      joined = true;
    }
  }
}

std::string label_at(const Area& area, std::size_t row) {
  const double step = (area.bottom - area.top) / static_cast<double>(kRows);
  for (const double tick : area.y.ticks) {
    const double y = area.y.at(tick) - area.top;
    if (y >= static_cast<double>(row) * step && y < static_cast<double>(row + 1) * step) {
      return tick_text(tick);
    }
  }
  return "";
}

std::string axis_below(const Area& area, std::size_t columns) {
  std::vector<std::pair<std::size_t, std::string>> labels;
  for (const double tick : area.x.ticks) {
    const double share = (area.x.at(tick) - area.left) / (area.right - area.left);
    labels.emplace_back(static_cast<std::size_t>(share * static_cast<double>(columns - 1)), tick_text(tick));
  }
  std::string line;
  for (const auto& [column, label] : labels) {
    const std::size_t at = columns_of(line);
    if (column >= at + (at > 0 ? 1 : 0) && column + columns_of(label) <= columns) {
      line += std::string(column - at, ' ') + label;
    }
  }
  return line;
}

}  // namespace

std::string to_terminal(const Figure& figure, std::size_t columns) {
  const std::vector<Plot> first(figure.plots.begin(), figure.plots.begin() + 1);
  const Layout plan = layout(first, 900.0);
  const Area& area = plan.areas.front();
  const std::size_t wide = std::max<std::size_t>(columns, 40) - kMargin - 1;
  Dots dots(wide, kRows);
  plot_cells(area, dots);
  plot_series(area, dots);
  std::string text = cut(figure.title, columns) + "\n" + cut(area.plot->y.name, columns) + "\n";
  for (std::size_t row = 0; row < kRows; ++row) {
    const std::string label = cut(label_at(area, row), kMargin - 1);
    text += std::string(kMargin - 1 - columns_of(label), ' ') + label + (label.empty() ? " │" : " ┤") + dots.row(row) +
            "\n";
  }
  text += std::string(kMargin, ' ') + "└";
  for (std::size_t i = 0; i < wide; ++i) {
    text += "─";
  }
  const std::string name = cut(first.front().x.name.empty() ? figure.plots.back().x.name : first.front().x.name, wide);
  text += "\n" + std::string(kMargin + 1, ' ') + axis_below(area, wide) + "\n" +
          std::string(kMargin + 1 + wide - columns_of(name), ' ') + name + "\n";
  for (const Series& series : area.plot->series) {
    if (series.key && (series.mark != Mark::None || series.dash.empty())) {
      text += cut(std::string(series.mark != Mark::None ? "  ⠶ " : "  ─ ") + series.name +
                      (series.detail.empty() ? "" : ", " + series.detail),
                  columns) +
              "\n";
    }
  }
  return text;
}

}  // namespace driftlab::figure
