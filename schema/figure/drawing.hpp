#pragma once
/// A figure as simple shapes, in the order in which they are painted: what the writers of SVG and PNG share.
#include "core/signal/result.hpp"
#include "schema/figure/layout.hpp"

namespace driftlab::figure {

struct Point {
  double x = 0.0;
  double y = 0.0;
};

enum class ShapeKind { Line, Path, Polygon, Circle, Text };
enum class Anchor { Start, Middle, End };

/// What a shape stands for; the test that compares drawings looks at cells, bands, curves, intervals and marks.
enum class Role { Frame, Grid, Guide, Cell, Band, Curve, Interval, Mark, Note, Key, Words };

struct Shape {
  ShapeKind kind = ShapeKind::Line;
  Role role = Role::Frame;
  std::vector<Point> points;
  double radius = 0.0;
  std::string fill = {};    ///< empty: none
  std::string stroke = {};  ///< likewise
  double width = 1.0;
  std::vector<double> dash = {};
  std::string text = {};
  Anchor anchor = Anchor::Start;
  double size = 12.0;
  bool halo = false;  ///< words keep a rim in the colour of the surface
  int clip = -1;      ///< area that it stays in
};

struct Drawing {
  double width = 0.0;
  double height = 0.0;
  std::vector<Area> areas;
  std::vector<Shape> shapes;
};

/// `figure` must outlive the drawing. The source stands in a line of its own under it.
[[nodiscard]] Drawing draw(const Figure& figure, double width);

/// As a file of its own: light palette, fonts named, no script.
[[nodiscard]] std::string to_svg(const Figure& figure, double width = 900.0);

/// As PNG with `scale` pixels for each of the SVG's. Error: Internal, where the library cannot make the picture.
[[nodiscard]] Result<std::string> to_png(const Figure& figure, double width = 900.0, double scale = 2.0);

/// The first plot in characters of two by four dots, at most `columns` wide: for a terminal.
[[nodiscard]] std::string to_terminal(const Figure& figure, std::size_t columns = 80);

}  // namespace driftlab::figure
