// Cells of a figure: where they reach, and which are drawn.
#include "schema/figure/drawing.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace driftlab::figure {
namespace {

Figure two_by_three(std::vector<double> values) {
  Plot plot{.x = {ScaleKind::Linear, "time, s"}, .y = {ScaleKind::Log, "frequency, Hz"}};
  plot.x.domain = {0.0, 20.0};
  plot.y.domain = {1.0, 100.0};
  plot.cells = {{5.0, 15.0}, {1.0, 10.0, 100.0}, std::move(values)};
  Figure figure;
  figure.plots = {std::move(plot)};
  return figure;
}

std::vector<Shape> cells_of(const Figure& figure) {
  std::vector<Shape> cells;
  for (const Shape& shape : draw(figure, 900.0).shapes) {
    if (shape.role == Role::Cell) {
      cells.push_back(shape);
    }
  }
  return cells;
}

TEST(Cells, AreTintedByTheirValueAndLeftOutWhereThereIsNone) {
  const std::vector<Shape> cells = cells_of(two_by_three({1.0, -1.0, 0.0, std::nan(""), 7.0, 0.5}));
  ASSERT_EQ(cells.size(), 4U);
  EXPECT_EQ(cells[0].fill, std::string(palette::kRobust) + "ff");
  EXPECT_EQ(cells[1].fill, std::string(palette::kModel) + "ff");
  EXPECT_EQ(cells[2].fill, std::string(palette::kRobust) + "ff");
  EXPECT_EQ(cells[3].fill, std::string(palette::kRobust) + "80");
}

TEST(Cells, ReachHalfWayToTheirNeighbours) {
  const Figure figure = two_by_three({1.0, 1.0, 1.0, 1.0, 1.0, 1.0});
  const Drawing drawing = draw(figure, 900.0);
  const Area& area = drawing.areas.front();
  const std::vector<Shape> cells = cells_of(figure);
  ASSERT_EQ(cells.size(), 6U);
  const auto right = [](const Shape& cell) {
    return std::max_element(cell.points.begin(), cell.points.end(), [](Point a, Point b) { return a.x < b.x; })->x;
  };
  const auto top = [](const Shape& cell) {
    return std::min_element(cell.points.begin(), cell.points.end(), [](Point a, Point b) { return a.y < b.y; })->y;
  };
  EXPECT_NEAR(right(cells[0]), area.x.at(10.0), 0.1);
  EXPECT_NEAR(right(cells[3]), area.right, 0.1);
  EXPECT_NEAR(top(cells[0]), area.y.at(std::sqrt(10.0)), 0.1);
}

TEST(Cells, StandInTheSvgByTheirRole) {
  const std::string svg = to_svg(two_by_three({1.0, -1.0, 0.0, 0.0, 0.0, 0.0}));
  EXPECT_NE(svg.find("class=\"cell\""), std::string::npos);
  EXPECT_NE(to_terminal(two_by_three({1.0, -1.0, 0.0, 0.0, 0.0, 0.0})).find("frequency, Hz"), std::string::npos);
}

}  // namespace
}  // namespace driftlab::figure
