#include "core/signal/condition.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace driftlab {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

TEST(Condition, ReadsTheCompactForm) {
  const auto rate = parse_condition("constant_rate:z:-9:deg/s");
  ASSERT_TRUE(rate);
  EXPECT_EQ(rate->kind, ConditionKind::ConstantRate);
  EXPECT_EQ(rate->axis, "z");
  EXPECT_DOUBLE_EQ(*rate->value, -9.0 * kDegree);
  EXPECT_DOUBLE_EQ(*parse_condition("constant_angular_acceleration:x:2:deg/s^2")->value, 2.0 * kDegree);
  EXPECT_EQ(parse_condition("six_position:y:down")->up, false);
  EXPECT_EQ(parse_condition("static")->kind, ConditionKind::Static);
}

TEST(Condition, GivesBackWhatItRead) {
  for (const char* const text :
       {"static", "static:90", "static:0", "static:212.5", "profile", "drive", "constant_rate:z:9:deg/s",
        "constant_rate:x:-0.1:rad/s", "constant_rate:y:15.041:deg/h", "constant_angular_acceleration:z:1:deg/s^2",
        "six_position:x:up"}) {
    EXPECT_EQ(to_text(*parse_condition(text)), text);
    EXPECT_EQ(*parse_condition(to_text(*parse_condition(text))), *parse_condition(text));
  }
}

TEST(Condition, AHeadingTurnsARecordingAtRestAndIsNoConditionOfItsOwn) {
  EXPECT_EQ(parse_condition("static:-90")->heading_deg, 270.0);
  EXPECT_EQ(parse_condition("static:360")->heading_deg, 0.0);
  EXPECT_EQ(without_heading(*parse_condition("static:90")), *parse_condition("static"));
  EXPECT_EQ(without_heading(*parse_condition("six_position:x:up")), *parse_condition("six_position:x:up"));
  EXPECT_FALSE(parse_condition("static:361"));
  EXPECT_FALSE(parse_condition("static:90:deg"));
  WrittenCondition moving{"profile", {}, {}, {}, {}, {}};
  moving.heading_deg = 90.0;
  EXPECT_FALSE(make_condition(moving));
}

TEST(Condition, RefusesWhatDoesNotFitItsKind) {
  const auto code = [](const char* text) {
    const auto condition = parse_condition(text);
    return condition ? std::string("accepted") : std::string(name_of(condition.error().code));
  };
  EXPECT_EQ(code(""), "unknown_condition");
  EXPECT_EQ(code("Static"), "unknown_condition");
  EXPECT_EQ(code("spinning"), "unknown_condition");
  EXPECT_EQ(code("static:z"), "invalid_argument");
  EXPECT_EQ(code("constant_rate"), "invalid_argument");
  EXPECT_EQ(code("constant_rate:z"), "invalid_argument");
  EXPECT_EQ(code("constant_rate:z:9"), "invalid_argument");
  EXPECT_EQ(code("constant_rate:w:9:deg/s"), "invalid_argument");
  EXPECT_EQ(code("constant_rate:z:fast:deg/s"), "invalid_argument");
  EXPECT_EQ(code("constant_rate:z:nan:deg/s"), "invalid_argument");
  EXPECT_EQ(code("constant_rate:z:9:deg/s:more"), "invalid_argument");
  EXPECT_EQ(code("constant_rate:z:9:furlong"), "unknown_unit");
  EXPECT_EQ(code("constant_rate:z:9:deg/s/131+2"), "unit_mismatch") << "what is true of counts is not of a rate";
  EXPECT_EQ(code("constant_rate:z:9:m/s^2"), "unit_mismatch");
  EXPECT_EQ(code("constant_angular_acceleration:z:9:deg/s"), "unknown_unit");
  EXPECT_EQ(code("six_position:x"), "invalid_argument");
  EXPECT_EQ(code("six_position:x:left"), "invalid_argument");
}

TEST(Condition, HasALabelForPeople) {
  EXPECT_EQ(label(*parse_condition("static")), "static");
  EXPECT_EQ(label(*parse_condition("constant_rate:z:9:deg/s")), "9 deg/s about z");
  EXPECT_EQ(label(*parse_condition("six_position:x:up")), "x up");
  EXPECT_EQ(label(*parse_condition("static:90")), "static, heading 90 deg");
}

}  // namespace
}  // namespace driftlab
