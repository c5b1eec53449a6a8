#include "schema/figure/drawing.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace driftlab::figure {
namespace {

double half(double x) { return std::round(x * 2.0) / 2.0; }
double tenth(double x) { return std::round(x * 10.0) / 10.0; }

Shape line(Role role, Point a, Point b, const char* stroke) {
  Shape shape;
  shape.role = role;
  shape.points = {a, b};
  shape.stroke = stroke;
  return shape;
}

Shape words(double x, double y, std::string text, Anchor anchor, const char* fill = palette::kInk2,
            double size = 12.0) {
  Shape shape;
  shape.kind = ShapeKind::Text;
  shape.role = Role::Words;
  shape.points = {{x, y}};
  shape.text = std::move(text);
  shape.anchor = anchor;
  shape.fill = fill;
  shape.size = size;
  return shape;
}

void add_axes(const Area& area, std::vector<Shape>& shapes) {
  const Plot& plot = *area.plot;
  for (const double tick : area.x.ticks) {
    const double x = half(area.x.at(tick));
    shapes.push_back(line(Role::Grid, {x, area.top}, {x, area.bottom}, palette::kHair));
  }
  for (const double tick : area.y.ticks) {
    const double y = half(area.y.at(tick));
    shapes.push_back(line(Role::Grid, {area.left, y}, {area.right, y}, palette::kHair));
  }
  for (const double value : plot.rules) {
    const double y = half(area.y.at(value));
    shapes.push_back(line(Role::Frame, {area.left, y}, {area.right, y}, palette::kRule));
  }
  if (!plot.hide_x) {
    for (const double tick : area.x.minor) {
      const double x = half(area.x.at(tick));
      shapes.push_back(line(Role::Frame, {x, area.bottom}, {x, area.bottom - 4.0}, palette::kRule));
    }
  }
  for (const double tick : area.y.minor) {
    const double y = half(area.y.at(tick));
    shapes.push_back(line(Role::Frame, {area.left, y}, {area.left + 4.0, y}, palette::kRule));
  }
  Shape frame;
  frame.kind = ShapeKind::Path;
  frame.stroke = palette::kRule;
  frame.points = {{area.left, area.top}, {area.left, area.bottom}};
  if (!plot.hide_x) {
    frame.points.push_back({area.right, area.bottom});
  }
  shapes.push_back(std::move(frame));
  if (!plot.hide_x) {
    for (const double tick : area.x.ticks) {
      shapes.push_back(words(half(area.x.at(tick)), area.bottom + 17.0, tick_text(tick), Anchor::Middle));
    }
  }
  for (const double tick : area.y.ticks) {
    shapes.push_back(words(area.left - 8.0, half(area.y.at(tick)) + 4.0, tick_text(tick), Anchor::End));
  }
  if (!plot.y.name.empty()) {
    shapes.push_back(words(0.0, area.top - 14.0, plot.y.name, Anchor::Start, palette::kInk));
  }
  if (!plot.hide_x && !plot.x.name.empty()) {
    shapes.push_back(words(area.right, area.bottom + 36.0, plot.x.name, Anchor::End, palette::kInk));
  }
}

constexpr double kGuidesBegin = 16.0;  ///< right of the frame

/// From one guide to the next.
double guides_apart(const Area& area) {
  constexpr double kWidest = 84.0;
  const double guides = std::max(1.0, static_cast<double>(area.plot->guides.size()));
  return std::min(kWidest, (area.right - area.left - kGuidesBegin) / guides);
}

void add_guides(const Area& area, std::vector<Shape>& shapes) {
  constexpr double kLongest = 46.0;
  constexpr double kRoomForText = 30.0;
  const double apart = guides_apart(area);
  const double length = std::min(kLongest, apart - kRoomForText);
  double x = area.left + kGuidesBegin;
  const double y = area.bottom - 30.0;
  for (const Guide& guide : area.plot->guides) {
    const double rise = guide.slope * length;
    shapes.push_back(line(Role::Guide, {x, y + rise / 2.0}, {x + length, y - rise / 2.0}, palette::kRule));
    Shape text = words(x + length + 5.0, y + 4.0, guide.text, Anchor::Start, palette::kInk3, 11.0);
    text.halo = true;
    shapes.push_back(std::move(text));
    x += apart;
  }
}

bool drawable(const std::optional<double>& value, bool log) {
  return value && std::isfinite(*value) && (!log || *value > 0.0);
}

/// Indices of a series inside the x axis that can be drawn.
std::vector<std::size_t> visible(const Series& series, const Area& area) {
  const bool log = area.plot->y.scale == ScaleKind::Log;
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < series.x.size() && i < series.y.size(); ++i) {
    const double x = series.x[i];
    if (drawable(series.y[i], log) && x >= area.x.low * (1.0 - 1e-12) - 1e-12 &&
        x <= area.x.high * (1.0 + 1e-12) + 1e-12) {
      found.push_back(i);
    }
  }
  return found;
}

std::optional<double> at(const std::vector<std::optional<double>>& values, std::size_t i) {
  return i < values.size() ? values[i] : std::nullopt;
}

/// Pixels half way between neighbours, and as far beyond the first and the last.
std::vector<double> edges_of(const std::vector<double>& middles, const Scale& scale) {
  std::vector<double> edges;
  for (std::size_t i = 0; i <= middles.size() && middles.size() > 1; ++i) {
    const std::size_t last = middles.size() - 1;
    const auto pixel = [&](std::size_t k) { return scale.at(middles[k]); };
    edges.push_back(i == 0     ? 1.5 * pixel(0) - 0.5 * pixel(1)
                    : i > last ? 1.5 * pixel(last) - 0.5 * pixel(last - 1)
                               : 0.5 * (pixel(i - 1) + pixel(i)));
  }
  return edges;
}

/// `#rrggbb` with the share of it that is seen; empty where less than one part in 64 is.
std::string tinted(double share) {
  constexpr std::array kDigits{'0', '1', '2', '3', '4', '5', '6', '7', '8', '9', 'a', 'b', 'c', 'd', 'e', 'f'};
  const auto alpha = static_cast<std::size_t>(std::lround(255.0 * std::min(1.0, std::abs(share))));
  if (!std::isfinite(share) || alpha < 4) {
    return "";
  }
  return std::string(share > 0.0 ? palette::kRobust : palette::kModel) + kDigits.at(alpha / 16) +
         kDigits.at(alpha % 16);
}

void add_cells(const Cells& cells, const Area& area, std::vector<Shape>& shapes) {
  const std::vector<double> x = edges_of(cells.x, area.x);
  const std::vector<double> y = edges_of(cells.y, area.y);
  for (std::size_t i = 0; i + 1 < x.size(); ++i) {
    for (std::size_t k = 0; k + 1 < y.size() && i * cells.y.size() + k < cells.values.size(); ++k) {
      Shape cell;
      cell.kind = ShapeKind::Polygon;
      cell.role = Role::Cell;
      cell.fill = tinted(cells.values[i * cells.y.size() + k]);
      cell.points = {{tenth(x[i]), tenth(y[k])},
                     {tenth(x[i + 1]), tenth(y[k])},
                     {tenth(x[i + 1]), tenth(y[k + 1])},
                     {tenth(x[i]), tenth(y[k + 1])}};
      if (!cell.fill.empty()) {
        shapes.push_back(std::move(cell));
      }
    }
  }
}

void add_band(const Series& series, const Area& area, std::vector<Shape>& shapes) {
  if (series.band.empty() || series.low.empty() || series.high.empty()) {
    return;
  }
  const bool log = area.plot->y.scale == ScaleKind::Log;
  Shape shape;
  shape.kind = ShapeKind::Polygon;
  shape.role = Role::Band;
  shape.fill = series.band;
  std::vector<Point> lower;
  for (const std::size_t i : visible(series, area)) {
    const auto high = at(series.high, i);
    if (!high || !std::isfinite(*high)) {
      continue;
    }
    const double x = tenth(area.x.at(series.x[i]));
    const auto low = at(series.low, i);
    shape.points.push_back({x, tenth(area.y.at(*high))});
    lower.push_back({x, tenth(low && drawable(low, log) ? area.y.at(*low) : area.bottom)});
  }
  shape.points.insert(shape.points.end(), lower.rbegin(), lower.rend());
  if (!shape.points.empty()) {
    shapes.push_back(std::move(shape));
  }
}

void add_curve(const Series& series, const Area& area, std::vector<Shape>& shapes) {
  if (!series.line) {
    return;
  }
  Shape shape;
  shape.kind = ShapeKind::Path;
  shape.role = Role::Curve;
  shape.stroke = series.colour;
  shape.width = series.width;
  shape.dash = series.dash;
  std::size_t before = 0;
  const auto flush = [&] {
    if (!shape.points.empty()) {
      shapes.push_back(shape);
      shape.points.clear();
    }
  };
  for (const std::size_t i : visible(series, area)) {
    if (i != before + 1) {
      flush();
    }
    before = i;
    const auto& y = series.y[i];
    if (y) {
      shape.points.push_back({tenth(area.x.at(series.x[i])), tenth(area.y.at(*y))});
    }
  }
  flush();
}

Shape mark_at(Mark mark, Point at, const std::string& colour) {
  constexpr double kSize = 3.4;
  Shape shape;
  shape.role = Role::Mark;
  shape.kind = ShapeKind::Circle;
  shape.points = {at};
  shape.radius = kSize;
  if (mark == Mark::Dot) {
    shape.fill = colour;
    return shape;
  }
  shape.fill = palette::kSurface;
  shape.stroke = colour;
  shape.width = 1.5;
  if (mark == Mark::Diamond) {
    shape.kind = ShapeKind::Polygon;
    const double reach = kSize + 1.0;
    shape.points = {{at.x, at.y - reach}, {at.x + reach, at.y}, {at.x, at.y + reach}, {at.x - reach, at.y}};
  }
  return shape;
}

void add_points(const Series& series, const Area& area, std::vector<Shape>& shapes) {
  if (series.mark == Mark::None) {
    return;
  }
  const bool log = area.plot->y.scale == ScaleKind::Log;
  for (const std::size_t i : visible(series, area)) {
    const double x = tenth(area.x.at(series.x[i]));
    const auto low = at(series.low, i);
    const auto high = at(series.high, i);
    if ((low && std::isfinite(*low)) || (high && std::isfinite(*high))) {
      const double y1 = tenth(low && drawable(low, log) ? area.y.at(*low) : area.bottom);
      const double y2 = tenth(drawable(high, log) ? area.y.at(*high) : area.top);
      Shape bar = line(Role::Interval, {x, y1}, {x, y2}, "");
      bar.stroke = series.colour;
      bar.width = 1.3;
      shapes.push_back(std::move(bar));
    }
    shapes.push_back(mark_at(series.mark, {x, tenth(area.y.at(*series.y[i]))}, series.colour));
  }
}

/// How far the text of each note that drops to the axis is lifted, so that it lies neither on its neighbour nor on the
/// guides.
std::vector<double> lifts_of(const Area& area) {
  constexpr double kWidth = 124.0;
  constexpr double kLines = 34.0;
  constexpr double kGuides = 48.0;
  const std::vector<Note>& notes = area.plot->notes;
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < notes.size(); ++i) {
    if (!notes[i].rule) {
      order.push_back(i);
    }
  }
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return notes[a].x < notes[b].x; });
  const double guides_end =
      area.left + kGuidesBegin + guides_apart(area) * static_cast<double>(area.plot->guides.size());
  std::vector<double> lifts(notes.size(), 0.0);
  double before = -std::numeric_limits<double>::infinity();
  double level = 0.0;
  for (const std::size_t i : order) {
    const double x = area.x.at(notes[i].x);
    level = x - before < kWidth ? level + 1.0 : 0.0;
    before = x;
    lifts[i] = level * kLines + (!area.plot->guides.empty() && x < guides_end ? kGuides : 0.0);
  }
  return lifts;
}

void add_note(const Note& note, const Area& area, double lift, std::vector<Shape>& shapes) {
  const double x = area.x.at(note.x);
  const double y = area.y.at(note.y);
  const double text_x = note.rule ? area.right : x + 6.0;
  const double text_y =
      note.rule ? y - (note.sub.empty() ? 6.0 : 17.0) : area.bottom - lift - (note.sub.empty() ? 8.0 : 22.0);
  const Anchor anchor = note.rule ? Anchor::End : Anchor::Start;
  if (note.rule) {
    shapes.push_back(
        line(Role::Note, {area.left + (area.right - area.left) * 0.62, y}, {area.right, y}, palette::kRule));
  } else {
    Shape drop = line(Role::Note, {x, y}, {x, area.bottom}, "");
    drop.stroke = note.colour;
    drop.dash = {1.0, 2.0};
    shapes.push_back(std::move(drop));
    Shape ring;
    ring.kind = ShapeKind::Circle;
    ring.role = Role::Note;
    ring.points = {{x, y}};
    ring.radius = 5.5;
    ring.stroke = note.colour;
    ring.width = 1.2;
    shapes.push_back(std::move(ring));
  }
  Shape text = words(text_x, text_y, note.text, anchor);
  text.fill = note.colour;
  text.halo = true;
  shapes.push_back(std::move(text));
  if (!note.sub.empty()) {
    Shape sub = words(text_x, note.rule ? y - 4.0 : text_y + 14.0, note.sub, anchor, palette::kInk3, 11.0);
    sub.halo = true;
    shapes.push_back(std::move(sub));
  }
}

void add_sample(const Series& series, double x, double y, std::vector<Shape>& shapes) {
  if (series.line) {
    Shape sample = line(Role::Key, {x, y}, {x + 22.0, y}, "");
    sample.stroke = series.colour;
    sample.width = series.width;
    sample.dash = series.dash;
    shapes.push_back(std::move(sample));
  }
  if (series.mark != Mark::None) {
    if (!series.low.empty()) {
      Shape bar = line(Role::Key, {x + 11.0, y - 7.0}, {x + 11.0, y + 7.0}, "");
      bar.stroke = series.colour;
      bar.width = 1.3;
      shapes.push_back(std::move(bar));
    }
    Shape mark = mark_at(series.mark, {x + 11.0, y}, series.colour);
    mark.role = Role::Key;
    shapes.push_back(std::move(mark));
  }
}

void add_keys(const Layout& plan, std::vector<Shape>& shapes) {
  const auto columns = static_cast<std::size_t>(std::max(1.0, std::floor(plan.width / 190.0)));
  std::size_t count = 0;
  for (const Area& area : plan.areas) {
    double y = area.top + 12.0;
    for (const Series& series : area.plot->series) {
      if (!series.key) {
        continue;
      }
      const std::size_t index = count++;
      const double x = plan.key_below ? static_cast<double>(index % columns) * 190.0 : plan.key_left;
      const std::size_t line = index / columns;
      const double at_y = plan.key_below ? plan.areas.back().foot + 12.0 + static_cast<double>(line) * 18.0 : y;
      y += series.detail.empty() ? 26.0 : 40.0;
      add_sample(series, x, at_y, shapes);
      shapes.push_back(words(x + 30.0, at_y + 4.0, series.name, Anchor::Start, palette::kInk));
      if (!series.detail.empty() && !plan.key_below) {
        shapes.push_back(words(x + 30.0, at_y + 18.0, series.detail, Anchor::Start, palette::kInk3, 11.0));
      }
    }
  }
}

void add_data(const Area& area, int index, std::vector<Shape>& shapes) {
  const std::vector<Series>& series = area.plot->series;
  const std::size_t first = shapes.size();
  add_cells(area.plot->cells, area, shapes);
  for (auto one = series.rbegin(); one != series.rend(); ++one) {
    add_band(*one, area, shapes);
  }
  for (auto one = series.rbegin(); one != series.rend(); ++one) {
    add_curve(*one, area, shapes);
  }
  for (auto one = series.rbegin(); one != series.rend(); ++one) {
    add_points(*one, area, shapes);
  }
  for (std::size_t i = first; i < shapes.size(); ++i) {
    shapes[i].clip = index;
  }
}

}  // namespace

Drawing draw(const Figure& figure, double width) {
  const Layout plan = layout(figure.plots, width);
  Drawing drawing{plan.width, plan.height + 20.0, plan.areas, {}};
  int index = 0;
  for (const Area& area : plan.areas) {
    add_axes(area, drawing.shapes);
    add_guides(area, drawing.shapes);
    add_data(area, index++, drawing.shapes);
    const std::vector<double> lifts = lifts_of(area);
    for (std::size_t i = 0; i < lifts.size(); ++i) {
      add_note(area.plot->notes[i], area, lifts[i], drawing.shapes);
    }
  }
  add_keys(plan, drawing.shapes);
  drawing.shapes.push_back(words(0.0, plan.height + 14.0, figure.source, Anchor::Start, palette::kInk3, 11.0));
  return drawing;
}

}  // namespace driftlab::figure
