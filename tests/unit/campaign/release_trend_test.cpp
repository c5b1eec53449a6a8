// A device that grows noisier by little at each release, and one that does not. The shares of more runs are those of
// tests/accuracy/regression_test.cpp. Seeds were fixed before looking.
#include "core/campaign/regression/release_trend.hpp"

#include "core/campaign/regression/verdict.hpp"
#include "tests/accuracy/regression_rig.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace driftlab {
namespace {

using accuracy::Releases;
using accuracy::Rig;
using regression::ReleaseTrend;

std::vector<ReleaseTrend> trends_of(const Releases& drawn) {
  const regression::Comparison comparison = regression::compare(drawn.design, accuracy::table_settings());
  return release_trends(drawn.design, scatter_terms(drawn.design), comparison.scatter, comparison.contrast, drawn.order,
                        1.0);
}

TEST(ReleaseTrend, SeesTwelveStepsOfOneAndAHalfPerCentThatNoPairOfReleasesShows) {
  const Rig rig(300.0);
  const double step = std::log1p(0.015);
  std::size_t densities = 0;
  for (std::size_t run = 0; run < 4; ++run) {
    Random random(11, run);
    bool seen = false;
    for (const ReleaseTrend& trend :
         trends_of(accuracy::draw_releases(rig, random, 13, 3, [&](const regression::Row& row, double release) {
           return row.unit == 2 ? step * release : 0.0;
         }))) {
      if (trend.unit != 2) {
        continue;
      }
      EXPECT_LT(trend.p, regression::kTrendWarning);
      EXPECT_NEAR(trend.slope, step, 0.5 * step);
      EXPECT_LT(trend.ci95.low, trend.slope);
      EXPECT_EQ(trend.releases, 13U);
      EXPECT_NEAR(trend.total, 12.0 * trend.slope, 1e-12);
      seen = seen || !trend.level;
      densities += trend.level ? 1U : 0U;
    }
    EXPECT_TRUE(seen);
  }
  EXPECT_GE(densities, 2U) << "N is followed where the structure of the axis holds";
}

TEST(ReleaseTrend, SeldomWarnsOfADeviceThatStaysAsItIs) {
  const Rig rig(300.0);
  std::size_t warned = 0;
  std::size_t covered = 0;
  std::size_t told = 0;
  for (std::size_t run = 0; run < 20; ++run) {
    Random random(12, run);
    for (const ReleaseTrend& trend :
         trends_of(accuracy::draw_releases(rig, random, 6, 2, [](const regression::Row&, double) { return 0.0; }))) {
      if (trend.level) {
        continue;  // another view of the same scales, and only where the structure holds
      }
      warned += trend.p < regression::kTrendWarning ? 1U : 0U;
      covered += trend.ci95.contains(0.0) ? 1U : 0U;
      ++told;
    }
  }
  ASSERT_EQ(told, 120U);
  // At 1 % of 120, six and more come in 0.1 % of the tests; of 5 % outside their interval, 15 and more in 0.4 %.
  EXPECT_LE(warned, 5U);
  EXPECT_GE(covered, 106U);
}

TEST(ReleaseTrend, NeedsThreeReleases) {
  const Rig rig(120.0);
  Random random(13);
  EXPECT_TRUE(trends_of(accuracy::draw_releases(rig, random, 2, 3, [](const regression::Row&, double) {
                return 0.0;
              })).empty());
}

TEST(ReleaseTrend, DoesNotDependOnWhichSessionComesFirst) {
  const Rig rig(120.0);
  Random random(14);
  Releases drawn = accuracy::draw_releases(rig, random, 4, 2, [](const regression::Row&, double) { return 0.0; });
  const std::vector<ReleaseTrend> before = trends_of(drawn);
  std::swap(drawn.design.sessions[0], drawn.design.sessions[1]);  // both of the baseline
  std::swap(drawn.design.sessions[4], drawn.design.sessions[6]);  // of two earlier releases
  std::swap(drawn.order.position[4], drawn.order.position[6]);
  const std::vector<ReleaseTrend> after = trends_of(drawn);
  ASSERT_EQ(before.size(), after.size());
  for (std::size_t i = 0; i < before.size(); ++i) {
    EXPECT_NEAR(before[i].slope, after[i].slope, 1e-9);
    EXPECT_NEAR(before[i].p, after[i].p, 1e-6);
  }
}

}  // namespace
}  // namespace driftlab
