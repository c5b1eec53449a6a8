// What a screen shows of a recording keeps every peak of it.
#include "core/signal/decimated_trace.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

namespace driftlab {
namespace {

TEST(DecimatedTrace, KeepsLeastGreatestAndMeanOfEveryStretch) {
  const std::vector<double> samples{1, 5, 3, -2, 0, 4, 7};
  const auto buckets = decimated_trace(samples, 3);
  ASSERT_EQ(buckets.size(), 3U);
  EXPECT_EQ(buckets[0].low, 1.0);
  EXPECT_EQ(buckets[0].high, 5.0);
  EXPECT_EQ(buckets[0].mean, 3.0);
  EXPECT_EQ(buckets[1].first, 3U);
  EXPECT_EQ(buckets[1].low, -2.0);
  EXPECT_EQ(buckets[2].present, 1U);
  EXPECT_EQ(buckets[2].mean, 7.0);
}

TEST(DecimatedTrace, OfFewSamplesGivesThemselves) {
  const std::vector<double> samples{2, 4};
  const auto buckets = decimated_trace(samples, 100);
  ASSERT_EQ(buckets.size(), 2U);
  EXPECT_EQ(buckets[1].low, 4.0);
  EXPECT_EQ(buckets[1].high, 4.0);
}

TEST(DecimatedTrace, LeavesOutWhatIsMissing) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<double> samples{nan, 3, nan, nan};
  const auto buckets = decimated_trace(samples, 2);
  EXPECT_EQ(buckets[0].present, 1U);
  EXPECT_EQ(buckets[0].low, 3.0);
  EXPECT_EQ(buckets[1].present, 0U);
  EXPECT_TRUE(decimated_trace({}, 5).empty());
}

}  // namespace
}  // namespace driftlab
