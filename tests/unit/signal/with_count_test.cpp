// Notes said "1 gaps", "1 samples are missing" and "1 rows of other attributes".
#include "core/signal/with_count.hpp"

#include <gtest/gtest.h>

namespace driftlab {
namespace {

TEST(WithCount, ExactlyOneTakesTheSingular) {
  EXPECT_EQ(with_count(0, "gap"), "0 gaps");
  EXPECT_EQ(with_count(1, "gap"), "1 gap");
  EXPECT_EQ(with_count(2, "gap"), "2 gaps");
}

TEST(WithCount, TheVerbAgreesWithTheNoun) {
  EXPECT_EQ(with_count(1, "sample is missing", "samples are missing"), "1 sample is missing");
  EXPECT_EQ(with_count(130275, "sample is missing", "samples are missing"), "130275 samples are missing");
  EXPECT_EQ(with_count(0, "axis", "axes"), "0 axes");
}

TEST(WithCount, OnceIsAWord) {
  EXPECT_EQ(how_often(1), "once");
  EXPECT_EQ(how_often(3), "3 times");
}

}  // namespace
}  // namespace driftlab
