// Which tests of a regression run are told first.
#include "core/campaign/regression/report.hpp"

#include <gtest/gtest.h>

namespace driftlab::regression {
namespace {

/// A test of margin 0.1; both ends are those of ln candidate/baseline.
ScaleReport test_of(const std::string& name, Finding finding, double lower, double upper_one, bool gated = true) {
  ScaleReport made;
  made.name = name;
  made.test.margin = 0.1;
  made.outcome.finding = finding;
  made.outcome.lower = lower;
  made.outcome.upper_one = upper_one;
  made.gated = gated;
  return made;
}

Report report_of(std::vector<ScaleReport> first, std::vector<ScaleReport> second) {
  Report report;
  report.units.resize(2);
  report.units[0].name = "gyroscope x";
  report.units[0].tests = std::move(first);
  report.units[1].name = "gyroscope y";
  report.units[1].tests = std::move(second);
  return report;
}

TEST(FurthestBeyond, IsTheTestWhoseWholeIntervalLiesFurthestBeyondItsMargin) {
  const Report report = report_of({test_of("a", Finding::Beyond, 0.15, 0.9), test_of("b", Finding::Open, 0.5, 0.9)},
                                  {test_of("c", Finding::Beyond, 0.3, 0.4), test_of("d", Finding::Beyond, 0.3, 0.8)});
  const ToldTest found = furthest_beyond(report);
  ASSERT_NE(found.test, nullptr);
  EXPECT_EQ(found.test->name, "c") << "the first of two equals, and not b, which is open";
  EXPECT_EQ(found.unit, &report.units[1]);
}

TEST(FurthestBeyond, IsNoneWhereNoTestIsBeyond) {
  EXPECT_EQ(furthest_beyond(report_of({test_of("a", Finding::Open, 0.5, 0.9)}, {})).test, nullptr);
}

TEST(ByDistance, HasTestsBeyondFirstThenGatedOnesThenWatchedOnesByTheirUpperEnds) {
  const Report report = report_of(
      {test_of("fine", Finding::Ok, -0.2, 0.0), test_of("watched", Finding::Open, 0.0, 0.6, false),
       test_of("open", Finding::Open, 0.0, 0.2), test_of("like it", Finding::Open, 0.0, 0.2)},
      {test_of("watched and beyond", Finding::Beyond, 0.2, 0.9, false), test_of("beyond", Finding::Beyond, 0.15, 0.3)});
  std::string order;
  for (const ToldTest& told : by_distance(report)) {
    order += told.test->name + "; ";
  }
  EXPECT_EQ(order, "beyond; watched and beyond; open; like it; fine; watched; ");
}

/// What an unchanged device would need does not decide one that sits on its margin.
TEST(Tell, AsksForNothingWhereATestSitsOnItsMargin) {
  for (const double theta : {0.09, 0.02}) {
    ScaleReport open = test_of("a", Finding::Open, 0.0, 0.2);
    open.theta = theta;
    Report report = report_of({open}, {});
    report.comparison.needs = {5U, 8.0};
    tell(report);
    const bool on_margin = theta > 0.05;
    EXPECT_EQ(report.needs.find("sits on the margin") != std::string::npos, on_margin) << report.needs;
    EXPECT_EQ(report.comparison.needs.sessions_per_arm.has_value(), !on_margin);
    EXPECT_EQ(report.needed_length_s.has_value(), !on_margin);
  }
}

}  // namespace
}  // namespace driftlab::regression
