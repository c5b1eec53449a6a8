#include "schema/text/trend_table.hpp"

#include <gtest/gtest.h>

namespace driftlab {
namespace {

TEST(TrendText, GivesALinePerTrendAndSaysWhereThereIsNone) {
  TrendTable table;
  EXPECT_EQ(trends_to_text(table), "No parameter is known under two conditions of one kind of motion.\n");
  ColumnTrend column;
  column.column = {"white_noise.N", "deg/sqrt(h)"};
  column.trend.direction = 1;
  column.trend.monotone_p = 0.001;
  column.trend.equal_p = 0.02;
  column.trend.relation.relation = Relation::Linear;
  column.trend.relation.low = 1.0;
  column.trend.relation.high = 2.0;
  column.trend.relation.scale = 40.0;
  table.trends.push_back(column);
  EXPECT_EQ(trends_to_text(table),
            "white_noise.N ↑ against |rate|: 1 +0.025 w deg/sqrt(h), w in deg/s (trend p = 0.001, equal p = 0.02). "
            "Rises with the dynamics.\n");
}

}  // namespace
}  // namespace driftlab
