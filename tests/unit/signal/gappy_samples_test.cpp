#include "core/signal/gappy_samples.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace driftlab {
namespace {

TEST(GappySamples, RowsAndGapsAreLaidOnTheGrid) {
  const std::vector<double> rows{1.0, 2.0, 3.0, 4.0};
  const std::vector<Gap> gaps{{1, 2}, {3, 1}};
  const auto samples = on_grid(rows, gaps);
  ASSERT_TRUE(samples.has_value());
  EXPECT_THAT(samples->values, testing::ElementsAre(1.0, 0.0, 0.0, 2.0, 3.0, 0.0, 4.0));
  EXPECT_THAT(samples->missing, testing::ElementsAre(0, 1, 1, 0, 0, 1, 0));
  EXPECT_EQ(samples->missing_count(), 3U);
  EXPECT_TRUE(samples->is_missing(5));
  EXPECT_FALSE(samples->is_missing(6));
}

TEST(GappySamples, WithoutGapsThereIsNoMask) {
  const std::vector<double> rows{1.0, 2.0};
  const auto samples = on_grid(rows, {});
  ASSERT_TRUE(samples.has_value());
  EXPECT_TRUE(samples->missing.empty());
  EXPECT_FALSE(samples->is_missing(1));
  EXPECT_EQ(samples->missing_count(), 0U);
}

TEST(GappySamples, RefusesGapsThatLieOutsideAndRecordsThatAreMostlyGap) {
  const std::vector<double> rows{1.0, 2.0, 3.0};
  for (const std::vector<Gap>& gaps :
       {std::vector<Gap>{{0, 1}}, {{3, 1}}, {{2, 1}, {1, 1}}, {{1, 1}, {1, 1}}, {{1, 0}}}) {
    const auto samples = on_grid(rows, gaps);
    ASSERT_FALSE(samples.has_value());
    EXPECT_EQ(samples.error().code, ErrorCode::InvalidArgument);
  }
  const std::vector<Gap> mostly{{1, 7}};
  EXPECT_EQ(on_grid(rows, mostly).error().code, ErrorCode::LimitExceeded);
}

}  // namespace
}  // namespace driftlab
