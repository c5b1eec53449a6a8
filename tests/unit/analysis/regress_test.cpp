#include "core/analysis/regress.hpp"

#include "tests/unit/campaign/regression_channels.hpp"

#include <gtest/gtest.h>

#include <algorithm>

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

TEST(Regress, ARunWithOtherSettingsThanItsAnchorSaysWhatChanged) {
  RegressRequest wanted = request();
  wanted.kept = wanted.comparison.settings;
  const auto says_so = [&] {
    const auto report = regress(wanted);
    const auto& details = report->report.summary.details;
    return std::find(details.begin(), details.end(),
                     "Settings differ from those kept with the anchor: margin.gyroscope 20, 25, 50 % (kept: 10, 25, 50 "
                     "%).") != details.end();
  };
  EXPECT_FALSE(says_so());
  wanted.comparison.settings.gyroscope.percent[0] = 20.0;
  EXPECT_TRUE(says_so());
  const regression::Settings own = wanted.comparison.settings;
  EXPECT_EQ(regression::with_kept(*wanted.kept, own, {}).gyroscope.percent[0], 10.0);
  EXPECT_EQ(regression::with_kept(*wanted.kept, own, {"margin"}).gyroscope.percent[0], 20.0);
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
