// Where a figure's axes begin and end, for the curves that it draws.
#include "schema/figure/axes.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace driftlab::figure {
namespace {

Plot plot_of(std::vector<Series> series) {
  Plot plot;
  plot.series = std::move(series);
  return plot;
}

TEST(FrameByCurves, HoldsEveryPositiveValueOfEveryCurveWithHalfAsMuchAgain) {
  // A simulation far below the measurement has no marks, and was outside the axis.
  Plot plot = plot_of({{.name = "measured", .x = {1.0, 2.0}, .y = {3.0, 6.0}, .mark = Mark::Dot},
                       {.name = "simulated", .x = {1.0, 2.0, 3.0}, .y = {0.03, std::nullopt, 0.0}, .line = true}});
  frame_by_curves(plot);
  ASSERT_TRUE(plot.y.domain);
  EXPECT_DOUBLE_EQ(plot.y.domain->first, 0.02);
  EXPECT_DOUBLE_EQ(plot.y.domain->second, 9.0);
  EXPECT_FALSE(plot.x.domain);
}

TEST(FrameByCurves, LeavesTheAxisWhereNothingIsPositive) {
  Plot plot = plot_of({{.name = "none", .x = {1.0, 2.0}, .y = {0.0, std::nullopt}}});
  frame_by_curves(plot);
  EXPECT_FALSE(plot.y.domain);
}

TEST(FrameAsMap, WidensTheShorterSideAboutTheMiddle) {
  // 100 m to the east, 10 m to the north: 4 m of margin all around, and 0.4 of 108 m is higher than 18 m.
  Plot flat = plot_of({{.name = "way", .x = {0.0, 100.0}, .y = {20.0, 30.0}}});
  frame_as_map(flat);
  EXPECT_TRUE(flat.equal_units);
  EXPECT_DOUBLE_EQ(flat.x.domain->first, -4.0);
  EXPECT_DOUBLE_EQ(flat.x.domain->second, 104.0);
  EXPECT_NEAR(flat.y.domain->first, 25.0 - 0.2 * 108.0, 1e-12);
  EXPECT_NEAR(flat.y.domain->second, 25.0 + 0.2 * 108.0, 1e-12);
  // The other way round the map is square.
  Plot high = plot_of({{.name = "way", .x = {20.0, 30.0}, .y = {0.0, 100.0}}});
  frame_as_map(high);
  EXPECT_NEAR(high.x.domain->second - high.x.domain->first, 108.0, 1e-12);
  EXPECT_NEAR(high.y.domain->second - high.y.domain->first, 108.0, 1e-12);
  EXPECT_NEAR(high.x.domain->first + high.x.domain->second, 50.0, 1e-12);
}

TEST(FrameAsMap, GivesAStandingVehicleAtLeastFourCentimetresAroundAndNothingToAnEmptyMap) {
  Plot still = plot_of({{.name = "way", .x = {5.0}, .y = {7.0}}});
  frame_as_map(still);
  EXPECT_NEAR(still.x.domain->second - still.x.domain->first, 0.08, 1e-12);
  Plot empty = plot_of({{.name = "way", .x = {5.0}, .y = {std::nullopt}}});
  frame_as_map(empty);
  EXPECT_FALSE(empty.x.domain);
  EXPECT_FALSE(empty.y.domain);
}

TEST(GreatestOf, CountsUpperEndsOfIntervalsAndPassesOverWhatIsNotKnown) {
  const Series series{
      .name = "N", .x = {0.0, 9.0, 4.0}, .y = {1.0, std::nullopt, 2.0}, .high = {1.5, std::nullopt, 3.5}};
  EXPECT_EQ(greatest_of(series), 3.5);
  EXPECT_EQ(greatest_of({.name = "bare", .x = {1.0}, .y = {2.0}}), 2.0);
  EXPECT_EQ(greatest_of({.name = "negative", .x = {1.0}, .y = {-2.0}}), 0.0);
  EXPECT_EQ(farthest_of(series), 9.0);
}

TEST(RatioTicks, AreRoundAndLieWithinTheLimit) {
  for (const double limit : {1.3, 1.7, 2.3, 8.0}) {
    for (const bool finer : {false, true}) {
      const std::vector<double> ticks = ratio_ticks(limit, finer);
      EXPECT_NE(std::find(ticks.begin(), ticks.end(), 1.0), ticks.end()) << limit;
      EXPECT_GE(ticks.front(), 1.0 / limit) << limit;
      EXPECT_LE(ticks.back(), limit) << limit;
    }
  }
  EXPECT_EQ(ratio_ticks(1.3).size(), 3U);
  EXPECT_EQ(ratio_ticks(1.3, true).size(), 5U);
}

}  // namespace
}  // namespace driftlab::figure
