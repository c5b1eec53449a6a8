// Numbers with fewer digits than they have.
#include "schema/text/printed.hpp"

#include <gtest/gtest.h>

namespace driftlab {
namespace {

TEST(FourDigits, HaveNoExponentWherePeopleWriteNone) {
  EXPECT_EQ(to_four_digits(0.0), "0");
  EXPECT_EQ(to_four_digits(0.00123456), "0.001235");
  EXPECT_EQ(to_four_digits(-3.14159), "-3.142");
  EXPECT_EQ(to_four_digits(98765.4), "98765");
  EXPECT_EQ(to_four_digits(123456.0), "1.235e+05");
  EXPECT_EQ(to_four_digits(0.0001236), "1.236e-04");
}

TEST(Tenths, LeaveOutATenthThatIsZero) {
  EXPECT_EQ(in_tenths(3.14), "3.1");
  EXPECT_EQ(in_tenths(2.97), "3");
  EXPECT_EQ(in_tenths(-0.26), "-0.3");
}

}  // namespace
}  // namespace driftlab
