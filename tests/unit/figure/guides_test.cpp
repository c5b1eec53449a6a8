// The strokes that show slopes in a figure of deviations.
#include "schema/figure/drawing.hpp"

#include <gtest/gtest.h>

#include <string>

namespace driftlab::figure {
namespace {

TEST(Guides, StayInsideTheirFrameHoweverManyThereAre) {
  Plot plot;
  plot.series = {{.name = "deviation", .x = {0.01, 100.0}, .y = {1.0, 0.01}, .mark = Mark::Dot}};
  plot.guides = {{-1.0, "−1"}, {-0.5, "−½"}, {0.0, "0"}, {0.5, "+½"}, {1.0, "+1"}};
  Figure figure{.title = "slopes"};
  figure.plots.push_back(plot);
  for (const double width : {900.0, 420.0}) {
    const Drawing drawing = draw(figure, width);
    ASSERT_EQ(drawing.areas.size(), 1U);
    const Area& area = drawing.areas.front();
    int strokes = 0;
    double before = area.left;
    for (const Shape& shape : drawing.shapes) {
      if (shape.role != Role::Guide || shape.kind != ShapeKind::Line) {
        continue;
      }
      ++strokes;
      EXPECT_GT(shape.points.front().x, before) << "they do not lie on each other";
      before = shape.points.back().x;
      for (const Point& point : shape.points) {
        EXPECT_LT(point.y, area.bottom) << "stroke " << strokes << " crosses the axis";
        EXPECT_LT(point.x, area.right);
      }
    }
    EXPECT_EQ(strokes, 5);
  }
}

}  // namespace
}  // namespace driftlab::figure
