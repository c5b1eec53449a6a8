#include "core/campaign/trend_table.hpp"

#include <gtest/gtest.h>

namespace driftlab {
namespace {

TableRow row(const char* condition, const ReportedValue& value) {
  TableRow made;
  made.condition = *parse_condition(condition);
  made.label = condition;
  made.cells = {{value, {}}};
  return made;
}

ReportedValue cell(double value) { return {value, value / 1.02, value * 1.02, "1/s", ""}; }

ParameterTable table(std::vector<TableRow> rows) {
  return {"phone", Quantity::AngularRate, "z", TableMethod::Gmwm, "WN+GM", {{"beta", "1/s"}}, std::move(rows)};
}

TEST(TrendTable, FollowsRatesByTheirMagnitudeAndAccelerationsApart) {
  const TrendTable found = build_trends(
      table({row("static", cell(1.0)), row("constant_rate:z:-9:deg/s", cell(1.5)),
             row("constant_rate:z:36:deg/s", cell(2.0)), row("constant_angular_acceleration:z:1:deg/s^2", cell(1.0))}));
  ASSERT_EQ(found.trends.size(), 2U);
  const ColumnTrend& rates = found.trends[0];
  EXPECT_EQ(rates.against, Dynamics::Rate);
  ASSERT_EQ(rates.points.size(), 3U);
  EXPECT_NEAR(rates.points[1].at, 9.0, 1e-9);
  EXPECT_EQ(rates.trend.direction, 1);
  EXPECT_TRUE(rates.trend.few);
  EXPECT_EQ(found.trends[1].against, Dynamics::AngularAcceleration);
  EXPECT_EQ(found.trends[1].trend.direction, 0);
  EXPECT_EQ(found.trends[1].trend.relation.relation, Relation::Constant);
}

TEST(TrendTable, SaysWhichConditionsItLeavesOut) {
  ReportedValue open = cell(1.2);
  open.high.reset();
  const ReportedValue unknown{{}, {}, {}, "1/s", "Not identifiable."};
  const TrendTable found =
      build_trends(table({row("static", cell(1.0)), row("constant_rate:z:9:deg/s", unknown),
                          row("constant_rate:z:18:deg/s", open), row("constant_rate:z:36:deg/s", cell(1.0))}));
  const std::vector<LeftOutPoint>& left_out = found.trends[0].left_out;
  ASSERT_EQ(left_out.size(), 2U);
  EXPECT_EQ(left_out[0].reason, "Not identifiable.");
  EXPECT_EQ(left_out[1].reason, "The interval is open.");
}

/// A filtered sensor whose model holds no white noise: its angle random walk is followed all the same.
TEST(TrendTable, FollowsTheOneDensityWhateverTheModel) {
  std::vector<TableRow> rows{row("static", cell(1.0)), row("constant_rate:z:9:deg/s", cell(1.0)),
                             row("constant_rate:z:36:deg/s", cell(1.0))};
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double value = 0.3 + 0.1 * static_cast<double>(i);
    rows[i].density.estimate = {value, value / 1.02, value * 1.02, "deg/sqrt(h)", ""};
  }
  ParameterTable with = table(rows);
  const TrendTable found = build_trends(with);
  ASSERT_EQ(found.trends.size(), 2U);
  EXPECT_EQ(found.trends[0].column.key, "N");
  EXPECT_EQ(found.trends[0].column.unit, "deg/sqrt(h)");
  EXPECT_EQ(found.trends[0].trend.direction, 1);
  EXPECT_EQ(found.trends[1].column.key, "beta");
  with.method = TableMethod::Av;
  EXPECT_EQ(build_trends(with).trends.size(), 1U) << "method av has N among its columns";
}

TEST(TrendTable, IsEmptyWhereNothingMoves) {
  EXPECT_TRUE(build_trends(table({row("static", cell(1.0))})).trends.empty());
}

TEST(TrendTable, WritesARelationAsPeopleDo) {
  FittedRelation relation;
  relation.low = 1.2;
  relation.high = 1.2;
  EXPECT_EQ(formula(relation), "1.2");
  relation.relation = Relation::Linear;
  relation.high = 0.2;
  relation.scale = 40.0;
  EXPECT_EQ(formula(relation), "1.2 -0.025 w");
  relation.relation = Relation::Power;
  relation.high = 3.2;
  relation.scale = 4.0;
  relation.exponent = 0.5;
  EXPECT_EQ(formula(relation), "1.2 +1 w^0.5");
}

}  // namespace
}  // namespace driftlab
