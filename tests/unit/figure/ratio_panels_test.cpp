// Panels of ratios and a badge: what is drawn of the points that are given.
#include "schema/figure/ratio_panels.hpp"

#include <gtest/gtest.h>

namespace driftlab::figure {
namespace {

RatioPanel panel_of(const std::string& name, std::size_t points) {
  RatioPanel panel{.name = name, .end_words = {"shortest", "longest"}};
  double tau_s = 0.1;
  for (std::size_t p = 0; p < points; ++p) {
    panel.points.push_back({.tau_s = tau_s, .ln_ratio = 0.0, .low = -0.1, .high = 0.1, .margin = 0.2});
    tau_s *= 10.0;
  }
  return panel;
}

bool holds(const std::string& svg, const std::string& part) { return svg.find(part) != std::string::npos; }

TEST(RatioPanels, SpanTheAveragingTimesOfTheirPointsAndTheScope) {
  // Three decades' points on 240 px: the middle one in the middle, and a scope of one decade half as wide.
  const std::string svg =
      to_svg(RatioPanels{.title = "t", .caption = "c", .scope_s = 1.0, .panels = {panel_of("x", 3)}});
  EXPECT_TRUE(holds(svg, "<rect x=\"46.0\" y=\"26.0\" width=\"120.0\" height=\"96.0\"")) << svg;
  EXPECT_TRUE(holds(svg, "<circle cx=\"166.0\" cy=\"74.0\"")) << svg;
  EXPECT_TRUE(holds(svg, ">shortest</text>") && holds(svg, ">longest</text>")) << svg;
  EXPECT_TRUE(holds(svg, "+30 %")) << "1.3 of the margin, as ln: " << svg;
}

TEST(RatioPanels, CrossAPointAndDrawNothingOfASinglePoint) {
  RatioPanel crossed = panel_of("x", 2);
  crossed.points[1].crossed = true;
  const std::string svg = to_svg(RatioPanels{.panels = {crossed, panel_of("alone", 1)}});
  EXPECT_TRUE(holds(svg, "<path d=\"M282.0")) << svg;
  EXPECT_EQ(svg.find("<polygon"), svg.rfind("<polygon")) << svg;
  EXPECT_TRUE(holds(svg, ">alone</text>")) << svg;
}

TEST(RatioPanels, WriteNamesAsText) {
  const std::string svg = to_svg(RatioPanels{.title = "a<b", .panels = {panel_of("x & y", 2)}});
  EXPECT_TRUE(holds(svg, "<title>a&lt;b</title>") && holds(svg, "x &amp; y")) << svg;
}

TEST(Badge, IsAsWideAsItsWords) {
  // 6.6 px a letter and 12 px beside them.
  const std::string svg = badge_svg("four", "four", "#2e7d32");
  EXPECT_TRUE(holds(svg, "width=\"77\" height=\"20\"")) << svg;
  EXPECT_TRUE(holds(svg, "fill=\"#2e7d32\"")) << svg;
}

}  // namespace
}  // namespace driftlab::figure
