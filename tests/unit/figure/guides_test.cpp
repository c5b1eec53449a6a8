// The strokes that show slopes in a figure of deviations.
#include "schema/figure/drawing.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

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

TEST(Guides, AndNeighboursAreLeftAloneByTheTextsOfNotes) {
  Plot plot;
  plot.series = {{.name = "deviation", .x = {0.01, 100.0}, .y = {1.0, 0.01}, .mark = Mark::Dot}};
  plot.x = {.scale = ScaleKind::Log, .name = "tau"};
  plot.y = {.scale = ScaleKind::Log, .name = "deviation"};
  plot.guides = {{-1.0, "−1"}, {-0.5, "−½"}, {0.0, "0"}, {0.5, "+½"}, {1.0, "+1"}};
  plot.notes = {{.x = 1.0, .y = 0.1, .text = "N = 0.3", .sub = "read at 1 s"},
                {.x = 3.0, .y = 0.05, .text = "K = 2", .sub = "read at 3 s"}};
  Figure figure{.title = "notes"};
  figure.plots.push_back(plot);
  const Drawing drawing = draw(figure, 900.0);
  std::vector<Point> texts;
  double highest_guide = drawing.areas.front().bottom;
  double guides_end = 0.0;
  for (const Shape& shape : drawing.shapes) {
    if (shape.role == Role::Guide) {
      for (const Point& point : shape.points) {
        highest_guide = std::min(highest_guide, point.y);
        guides_end = std::max(guides_end, point.x);
      }
    }
    if (shape.text == "N = 0.3" || shape.text == "K = 2") {
      texts.push_back(shape.points.front());
    }
  }
  ASSERT_EQ(texts.size(), 2U);
  EXPECT_LT(texts[0].x, guides_end) << "the story needs a note among the guides";
  constexpr double kSub = 14.0;  // below the text
  EXPECT_LT(texts[0].y + kSub, highest_guide);
  EXPECT_LT(texts[1].y + kSub, texts[0].y - 8.0) << "the next one stands above it";
}

}  // namespace
}  // namespace driftlab::figure
