#include "core/analysis/regress.hpp"

#include "tests/unit/campaign/regression_channels.hpp"

#include <gtest/gtest.h>

namespace driftlab {
namespace {

RegressRequest request() {
  RegressRequest made;
  Random random(3);
  for (std::size_t s = 0; s < 4; ++s) {
    std::vector<double> x(4000);
    for (double& value : x) {
      value = random.normal();
    }
    auto& arm = s < 2 ? made.comparison.baseline : made.comparison.candidate;
    arm.recordings.push_back(
        regression::recording_of(std::to_string(s), {regression::channel_of(x, 0.05, "angular_rate", "z", "deg/s")}));
  }
  return made;
}

TEST(Regress, ALookTakesItsShareOfTheLevelAndAFourthNone) {
  EXPECT_DOUBLE_EQ(*look_share({1, 3, true}), 0.6);
  EXPECT_DOUBLE_EQ(*look_share({2, 3, true}) + *look_share({3, 3, true}), 0.4);
  EXPECT_DOUBLE_EQ(*look_share({1, 1, false}), 1.0);
  const auto fourth = look_share({4, 3, true});
  ASSERT_FALSE(fourth);
  EXPECT_EQ(fourth.error().code, ErrorCode::Conflict);
  EXPECT_FALSE(look_share({2, 1, true}));
}

TEST(Regress, ALaterLookIsStricterBothWays) {
  RegressRequest wanted = request();
  const auto first = regress(wanted);
  wanted.look.number = 3;
  const auto third = regress(wanted);
  ASSERT_TRUE(first && third);
  EXPECT_GT(third->report.comparison.c_1, first->report.comparison.c_1);
  EXPECT_GT(third->report.comparison.c_max, first->report.comparison.c_max);
}

TEST(Regress, ASettingOutsideItsRangeIsNamed) {
  RegressRequest wanted = request();
  wanted.comparison.settings.test.alpha = 0.9;
  const auto refused = regress(wanted);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().fields, (std::vector<ErrorField>{{"parameter", "alpha"}}));
}

}  // namespace
}  // namespace driftlab
