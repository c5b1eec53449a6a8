#include "schema/figure/drawing.hpp"
#include "schema/figure/svg_text.hpp"

#include <array>
#include <cstdio>

namespace driftlab::figure {

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    out += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '>' ? "&gt;" : c == '"' ? "&quot;" : std::string(1, c);
  }
  return out;
}

namespace {

/// A pixel with at most two decimals, none that are zero.
std::string pixel(double value) {
  std::array<char, 32> buffer{};
  (void)std::snprintf(buffer.data(), buffer.size(), "%.2f", value);
  std::string text = buffer.data();
  text.erase(text.find_last_not_of('0') + 1);
  text.erase(text.find_last_not_of('.') + 1);
  return text == "-0" ? "0" : text;
}

std::string path_of(const Shape& shape) {
  std::string path;
  for (const Point& point : shape.points) {
    path += (path.empty() ? "M" : "L") + pixel(point.x) + "," + pixel(point.y);
  }
  return shape.kind == ShapeKind::Polygon ? path + "Z" : path;
}

std::string paint_of(const Shape& shape) {
  std::string text = " fill=\"" + (shape.fill.empty() ? std::string("none") : shape.fill) + "\"";
  if (!shape.stroke.empty()) {
    text += " stroke=\"" + shape.stroke + "\" stroke-width=\"" + pixel(shape.width) + "\"";
  }
  if (!shape.dash.empty()) {
    text += " stroke-dasharray=\"";
    for (std::size_t i = 0; i < shape.dash.size(); ++i) {
      text += (i == 0 ? "" : " ") + pixel(shape.dash[i]);
    }
    text += "\"";
  }
  return text;
}

const char* name_of(Role role) {
  switch (role) {
    case Role::Frame:
      return "frame";
    case Role::Grid:
      return "grid";
    case Role::Guide:
      return "guide";
    case Role::Cell:
      return "cell";
    case Role::Band:
      return "band";
    case Role::Curve:
      return "curve";
    case Role::Interval:
      return "interval";
    case Role::Mark:
      return "mark";
    case Role::Note:
      return "note";
    case Role::Key:
      return "key";
    case Role::Words:
      break;
  }
  return "words";
}

std::string words_of(const Shape& shape) {
  const char* const anchor = shape.anchor == Anchor::Start    ? "start"
                             : shape.anchor == Anchor::Middle ? "middle"
                                                              : "end";
  std::string text = "<text x=\"" + pixel(shape.points[0].x) + "\" y=\"" + pixel(shape.points[0].y) +
                     "\" text-anchor=\"" + anchor + "\" font-size=\"" + pixel(shape.size) + "\" fill=\"" + shape.fill +
                     "\"";
  if (shape.halo) {
    text += " paint-order=\"stroke\" stroke=\"" + std::string(palette::kSurface) +
            "\" stroke-width=\"3\" stroke-linejoin=\"round\"";
  }
  return text + ">" + escaped(shape.text) + "</text>\n";
}

std::string element_of(const Shape& shape) {
  if (shape.kind == ShapeKind::Text) {
    return words_of(shape);
  }
  const std::string role = std::string(" class=\"") + name_of(shape.role) + "\"";
  if (shape.kind == ShapeKind::Line) {
    const Point& a = shape.points[0];
    const Point& b = shape.points[1];
    return "<line" + role + " x1=\"" + pixel(a.x) + "\" y1=\"" + pixel(a.y) + "\" x2=\"" + pixel(b.x) + "\" y2=\"" +
           pixel(b.y) + "\"" + paint_of(shape) + "/>\n";
  }
  if (shape.kind == ShapeKind::Circle) {
    return "<circle" + role + " cx=\"" + pixel(shape.points[0].x) + "\" cy=\"" + pixel(shape.points[0].y) + "\" r=\"" +
           pixel(shape.radius) + "\"" + paint_of(shape) + "/>\n";
  }
  return "<path" + role + " d=\"" + path_of(shape) + "\"" + paint_of(shape) + " stroke-linejoin=\"round\"/>\n";
}

}  // namespace

std::string to_svg(const Figure& figure, double width) {
  const Drawing drawing = draw(figure, width);
  const std::string size = pixel(drawing.width) + "\" height=\"" + pixel(drawing.height);
  std::string svg = "<svg xmlns=\"http://www.w3.org/2000/svg\" role=\"img\" width=\"" + size + "\" viewBox=\"0 0 " +
                    pixel(drawing.width) + " " + pixel(drawing.height) +
                    "\" font-family=\"Inter,Helvetica,Arial,sans-serif\">\n<title>" + escaped(figure.title) +
                    "</title>\n<desc>" + escaped(figure.sentence) + "</desc>\n<rect width=\"" + size + "\" fill=\"" +
                    palette::kSurface + "\"/>\n";
  // Clips by area: an id made of the title is unique in a page of several figures.
  std::string id = "c";
  for (const char c : figure.title + figure.source) {
    id += (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ? c : '-';
  }
  for (std::size_t i = 0; i < drawing.areas.size(); ++i) {
    const Area& area = drawing.areas[i];
    svg += "<clipPath id=\"" + id + std::to_string(i) + "\"><rect x=\"" + pixel(area.left) + "\" y=\"" +
           pixel(area.top - 6.0) + "\" width=\"" + pixel(area.right - area.left + 6.0) + "\" height=\"" +
           pixel(area.bottom - area.top + 6.0) + "\"/></clipPath>\n";
  }
  int clip = -1;
  for (const Shape& shape : drawing.shapes) {
    if (shape.clip != clip) {
      svg += clip >= 0 ? "</g>\n" : "";
      clip = shape.clip;
      svg += clip >= 0 ? "<g clip-path=\"url(#" + id + std::to_string(clip) + ")\">\n" : "";
    }
    svg += element_of(shape);
  }
  return svg + "</svg>\n";
}

}  // namespace driftlab::figure
