#include "schema/figure/drawing.hpp"

#include <cairo/cairo.h>

#include <array>
#include <cstdlib>
#include <memory>

namespace driftlab::figure {
namespace {

using Surface = std::unique_ptr<cairo_surface_t, decltype(&cairo_surface_destroy)>;
using Context = std::unique_ptr<cairo_t, decltype(&cairo_destroy)>;

/// `#rrggbb` or `#rrggbbaa`.
void set_colour(cairo_t* cairo, const std::string& colour) {
  std::array<double, 4> parts{0.0, 0.0, 0.0, 1.0};
  for (std::size_t i = 0; i < parts.size() && 2 * i + 2 < colour.size(); ++i) {
    parts[i] = static_cast<double>(std::strtol(colour.substr(2 * i + 1, 2).c_str(), nullptr, 16)) / 255.0;
  }
  cairo_set_source_rgba(cairo, parts[0], parts[1], parts[2], parts[3]);
}

void paint(cairo_t* cairo, const Shape& shape) {
  if (!shape.fill.empty()) {
    set_colour(cairo, shape.fill);
    cairo_fill_preserve(cairo);
  }
  if (!shape.stroke.empty()) {
    set_colour(cairo, shape.stroke);
    cairo_set_line_width(cairo, shape.width);
    cairo_set_dash(cairo, shape.dash.data(), static_cast<int>(shape.dash.size()), 0.0);
    cairo_stroke_preserve(cairo);
  }
  cairo_new_path(cairo);
}

void paint_words(cairo_t* cairo, const Shape& shape) {
  cairo_select_font_face(cairo, "sans-serif", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
  cairo_set_font_size(cairo, shape.size);
  cairo_text_extents_t extents;
  cairo_text_extents(cairo, shape.text.c_str(), &extents);
  const double share = shape.anchor == Anchor::Start ? 0.0 : shape.anchor == Anchor::Middle ? 0.5 : 1.0;
  cairo_move_to(cairo, shape.points[0].x - share * extents.x_advance, shape.points[0].y);
  cairo_text_path(cairo, shape.text.c_str());
  if (shape.halo) {
    set_colour(cairo, palette::kSurface);
    cairo_set_line_width(cairo, 3.0);
    cairo_set_dash(cairo, nullptr, 0, 0.0);
    cairo_stroke_preserve(cairo);
  }
  set_colour(cairo, shape.fill);
  cairo_fill(cairo);
}

void add_path(cairo_t* cairo, const Shape& shape) {
  constexpr double kTurn = 6.283185307179586;
  if (shape.kind == ShapeKind::Circle) {
    cairo_arc(cairo, shape.points[0].x, shape.points[0].y, shape.radius, 0.0, kTurn);
    return;
  }
  for (const Point& point : shape.points) {
    cairo_line_to(cairo, point.x, point.y);
  }
  if (shape.kind == ShapeKind::Polygon) {
    cairo_close_path(cairo);
  }
}

cairo_status_t append(void* into, const unsigned char* bytes, unsigned int count) {
  static_cast<std::string*>(into)->append(reinterpret_cast<const char*>(bytes), count);
  return CAIRO_STATUS_SUCCESS;
}

}  // namespace

Result<std::string> to_png(const Figure& figure, double width, double scale) {
  const Drawing drawing = draw(figure, width);
  const Surface surface(cairo_image_surface_create(CAIRO_FORMAT_RGB24, static_cast<int>(drawing.width * scale),
                                                   static_cast<int>(drawing.height * scale)),
                        cairo_surface_destroy);
  const Context context(cairo_create(surface.get()), cairo_destroy);
  cairo_t* const cairo = context.get();
  cairo_scale(cairo, scale, scale);
  cairo_set_line_join(cairo, CAIRO_LINE_JOIN_ROUND);
  set_colour(cairo, palette::kSurface);
  cairo_paint(cairo);
  for (const Shape& shape : drawing.shapes) {
    cairo_save(cairo);
    if (shape.clip >= 0) {
      const Area& area = drawing.areas[static_cast<std::size_t>(shape.clip)];
      cairo_rectangle(cairo, area.left, area.top - 6.0, area.right - area.left + 6.0, area.bottom - area.top + 6.0);
      cairo_clip(cairo);
    }
    if (shape.kind == ShapeKind::Text) {
      paint_words(cairo, shape);
    } else {
      add_path(cairo, shape);
      paint(cairo, shape);
    }
    cairo_restore(cairo);
  }
  std::string png;
  const cairo_status_t status = cairo_surface_write_to_png_stream(surface.get(), append, &png);
  if (status != CAIRO_STATUS_SUCCESS) {
    return fail(ErrorCode::Internal,
                std::string("The picture cannot be made: ") + cairo_status_to_string(status) + ".");
  }
  return png;
}

}  // namespace driftlab::figure
