// A figure said more than its interval lets stand: 297.3 [180.1, 467.2] is 300.
#include "core/signal/significant.hpp"

#include <gtest/gtest.h>

namespace driftlab {
namespace {

TEST(Significant, IntervalDecidesTheDigits) {
  // The cases of schema/number-format.json, which the pages are held to as well.
  EXPECT_EQ(significant(1.0382, 1.0347, 1.0417), "1.038");
  EXPECT_EQ(significant(297.3, 180.1, 467.2), "300");
  EXPECT_EQ(significant(62.419, 57.3, 68.2), "62");
  EXPECT_EQ(significant(0.323394, 0.2401, 0.4302), "0.32");
  EXPECT_EQ(significant(-1.6213, -1.89, -1.35), "-1.6");
  EXPECT_EQ(significant(0.000561, 0.000551, 0.000571), "0.000561");
}

TEST(Significant, WithoutAnIntervalThreeDigits) {
  EXPECT_EQ(significant(8.2229), "8.22");
  EXPECT_EQ(significant(0.0054321), "0.00543");
  EXPECT_EQ(significant(1234.5), "1235");  // the whole part is never rounded off
  EXPECT_EQ(significant(41.0, 41.0, {}), "41.0");
  EXPECT_EQ(significant(0.0), "0");
}

TEST(Significant, VerySmallAndVeryLargeHaveAnExponent) {
  EXPECT_EQ(significant(2.6451e-5, 1.29e-5, 4.44e-5), "2.6e-5");
  EXPECT_EQ(significant(3.2e9), "3.20e9");
}

}  // namespace
}  // namespace driftlab
