// A number with its interval.
#include "core/signal/estimate.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace driftlab {
namespace {

TEST(Interval, IsHalfAsWideAsItsEndsLieApart) {
  EXPECT_EQ((Interval{-1.0, 4.0}.half_width()), 2.5);
  EXPECT_EQ((Interval{3.0, 3.0}.half_width()), 0.0);
}

TEST(Interval, HasNoWidthWhereAnEndIsOpen) {
  EXPECT_TRUE(std::isinf(Interval{}.half_width()));
  EXPECT_TRUE(std::isinf(Interval{.low = 2.0}.half_width()));
  EXPECT_TRUE(std::isinf(Interval{.high = 2.0}.half_width()));
}

}  // namespace
}  // namespace driftlab
