#include "core/analysis/simulate.hpp"

#include "core/analysis/evaluate_outages.hpp"
#include "core/process/model.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace driftlab {
namespace {

AxisSimulation at(const char* condition) { return {*parse_condition(condition), 100.0, 20.0, 5}; }

TEST(SimulatePreset, AddsTheMotionOfTheConditionToTheSameError) {
  const auto still = simulate_preset("iphone5s-z", at("static"));
  const auto again = simulate_preset("iphone5s-z", at("static"));
  ASSERT_TRUE(still && again);
  EXPECT_EQ(still->values, again->values);
  EXPECT_EQ(still->rows(), 2000U);
  const auto turning = simulate_preset("iphone5s-z", at("constant_rate:z:9:deg/s"));
  ASSERT_TRUE(turning) << turning.error().message;
  double mean = 0.0;
  for (const double value : turning->values) {
    mean += value / 2000.0;
  }
  EXPECT_NEAR(mean, 9.0, 1.0);  // the error is some hundredths of deg/s
}

TEST(SimulatePreset, NamesWhatIsNotThere) {
  const auto none = simulate_preset("no-such-sensor", at("static"));
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().code, ErrorCode::NotFound);
}

TEST(SimulateModel, LeavesOutAbsentSamplesAndNeverStepsBack) {
  investigate::Baseline model;
  model.automatic = false;
  model.processes = {make_process("white_noise", {1e-3}).value()};
  const auto whole = simulate_model(model, "", at("static"));
  ASSERT_TRUE(whole) << whole.error().message;
  EXPECT_EQ(whole->table.columns, (std::vector<std::string>{"t [s]", "gz [deg/s]"}));
  EXPECT_EQ(whole->table.rows(), 2000U);
  model.effects = {{"missing_samples", {}, {}, {0.1}}, {"timestamp_jitter", {}, {}, {0.004}}};
  const auto holed = simulate_model(model, "", at("static"));
  ASSERT_TRUE(holed) << holed.error().message;
  EXPECT_TRUE(holed->left_out.empty());
  EXPECT_LT(holed->table.rows(), 2000U);
  for (std::size_t row = 1; row < holed->table.rows(); ++row) {
    ASSERT_LE(holed->table.at(row - 1, 0), holed->table.at(row, 0)) << row;
  }
}

TEST(SimulateModel, SaysWhatItCannotBringAbout) {
  investigate::Baseline model;
  model.automatic = false;
  model.effects = {{"temperature_bias", {}, {}, {1e-4}}};
  const auto made = simulate_model(model, "", at("static"));
  ASSERT_TRUE(made) << made.error().message;
  ASSERT_EQ(made->left_out.size(), 1U);
  EXPECT_EQ(made->left_out[0].rfind("temperature_bias: ", 0), 0U);
}

TEST(SimulateModel, RefusesAChannelThatTheModelDoesNotHave) {
  investigate::Baseline model;
  model.by_channel["gx"] = {make_process("white_noise", {1e-3}).value()};
  const auto none = simulate_model(model, "gy", at("static"));
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().code, ErrorCode::NotFound);
}

TEST(SimulateDrive, GivesTheTablesThatWereAskedFor) {
  DriveSimulation wanted;
  wanted.scenario = *paper_scenario("paper");
  wanted.scenario.imu_rate_hz = 20.0;
  const auto bare = simulate_drive(wanted);
  ASSERT_TRUE(bare) << bare.error().message;
  EXPECT_FALSE(bare->fixes || bare->truth);
  wanted.fixes = true;
  wanted.truth = true;
  const auto whole = simulate_drive(wanted);
  ASSERT_TRUE(whole);
  EXPECT_EQ(whole->imu.values, bare->imu.values);
  ASSERT_TRUE(whole->fixes && whole->truth);
  EXPECT_EQ(whole->fixes->columns.size(), whole->fixes->decimals.size());
  EXPECT_EQ(whole->truth->rows(), whole->imu.rows() + 1);  // states at both ends of every interval
  EXPECT_EQ(whole->truth->at(0, 0), 0.0);
  EXPECT_GT(whole->fixes->rows(), 400U);  // one a second for eight minutes
}

}  // namespace
}  // namespace driftlab
