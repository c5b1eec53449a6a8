#include "schema/json/trend_table.hpp"

#include <gtest/gtest.h>

namespace driftlab {
namespace {

Json cell(double value) {
  return {{"value", value}, {"unit", "1/s"}, {"ci95", {value / 1.02, value * 1.02}}, {"change", nullptr}};
}

Json row(const Json& condition, const char* label, const Json& value) {
  Json reasons = Json::object();
  if (value.is_null()) {
    reasons["beta"] = "Not identifiable.";
  }
  return {{"condition", condition}, {"label", label}, {"values", {{"beta", value}}}, {"reasons", reasons}};
}

Json rate(double value) { return {{"kind", "constant_rate"}, {"axis", "z"}, {"value", value}, {"unit", "deg/s"}}; }

Json table(std::vector<Json> rows) {
  return {{"device", "phone"},      {"sensor", "gyroscope"}, {"axis", "z"},
          {"method", "gmwm"},       {"model", "WN+GM"},      {"columns", {{{"key", "beta"}, {"unit", "1/s"}}}},
          {"rows", std::move(rows)}};
}

TEST(TrendTable, FollowsRatesByTheirMagnitudeAndAccelerationsApart) {
  const Json ramp{{"kind", "constant_angular_acceleration"}, {"axis", "z"}, {"value", 1.0}, {"unit", "deg/s^2"}};
  const Json document =
      build_trends(table({row({{"kind", "static"}}, "static", cell(1.0)), row(rate(-9.0), "-9", cell(1.5)),
                          row(rate(36.0), "36", cell(2.0)), row(ramp, "ramp", cell(1.0))}));
  ASSERT_EQ(document["trends"].size(), 2U);
  const Json& rates = document["trends"][0];
  EXPECT_EQ(rates["against"]["unit"], "deg/s");
  ASSERT_EQ(rates["points"].size(), 3U);
  EXPECT_NEAR(rates["points"][1]["at"].get<double>(), 9.0, 1e-9);
  EXPECT_EQ(rates["monotone"]["direction"], "up");
  EXPECT_TRUE(rates["monotone"]["few"].get<bool>());
  EXPECT_EQ(document["trends"][1]["against"]["kind"], "angular_acceleration");
  EXPECT_EQ(document["trends"][1]["monotone"]["direction"], "none");
  EXPECT_EQ(document["trends"][1]["relation"]["kind"], "constant");
}

TEST(TrendTable, SaysWhichConditionsItLeavesOut) {
  Json open = cell(1.2);
  open["ci95"][1] = nullptr;
  const Json document =
      build_trends(table({row({{"kind", "static"}}, "static", cell(1.0)), row(rate(9.0), "9", nullptr),
                          row(rate(18.0), "18", open), row(rate(36.0), "36", cell(1.0))}));
  const Json& left_out = document["trends"][0]["left_out"];
  ASSERT_EQ(left_out.size(), 2U);
  EXPECT_EQ(left_out[0]["reason"], "Not identifiable.");
  EXPECT_EQ(left_out[1]["reason"], "The interval is open.");
}

TEST(TrendTable, IsEmptyWhereNothingMoves) {
  const Json document = build_trends(table({row({{"kind", "static"}}, "static", cell(1.0))}));
  EXPECT_TRUE(document["trends"].empty());
  EXPECT_EQ(trends_to_text(document), "No parameter is known under two conditions of one kind of motion.\n");
}

}  // namespace
}  // namespace driftlab
