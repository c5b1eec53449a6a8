/// What an investigation left of a sensor, put into the scenario of an outage.
#include "core/analysis/modelled_sensor.hpp"

#include "core/process/registry.hpp"

#include <gtest/gtest.h>

namespace driftlab {
namespace {

using investigate::Baseline;

Model white(double density) { return {{find_process("white_noise"), {density}}}; }

/// A model of two gyroscope columns: gz with a bias and a drift, gx with neither.
Baseline two_columns() {
  Baseline model;
  model.automatic = false;
  model.processes = white(1e-5);
  model.by_channel = {{"gx", white(1e-5)}, {"gz", white(3e-5)}};
  model.quantity_by_channel = {{"gx", Quantity::AngularRate}, {"gz", Quantity::AngularRate}};
  model.bias["gz"] = 2e-3;
  model.drift["gz"] = 4e-8;
  return model;
}

TEST(ModelledSensor, TakesTheUsualColumnOfEachAxisWithItsDriftAsAProcess) {
  const auto made = sensor_of_model(two_columns(), {.axes = {2, 0}});
  ASSERT_TRUE(made) << made.error().message;
  ASSERT_EQ(made->axes.size(), 2);
  const ModelledAxis& z = made->axes[0];
  EXPECT_EQ(z.axis, 2);
  EXPECT_EQ(z.bias, 2e-3);
  ASSERT_EQ(z.processes.size(), 2);
  EXPECT_EQ(z.processes[0].parameters.front(), 3e-5);
  EXPECT_EQ(z.processes[1].kind->name, "linear_drift");
  EXPECT_EQ(z.processes[1].parameters.front(), 4e-8);
  EXPECT_EQ(made->axes[1].processes.size(), 1);
  EXPECT_TRUE(made->left_out.empty()) << "the truth has its bias";
}

TEST(ModelledSensor, AFilterIsNotToldABiasAndThatIsSaid) {
  const auto biased = sensor_of_model(two_columns(), {.truth = false, .axes = {2}});
  const auto other = sensor_of_model(two_columns(), {.truth = false, .axes = {0}});
  ASSERT_TRUE(biased && other);
  EXPECT_EQ(biased->left_out, std::vector<std::string>{"bias"});
  EXPECT_TRUE(other->left_out.empty()) << "the bias is one of gz alone";
}

TEST(ModelledSensor, NamesTheEffectsOnColumnsInUseOnly) {
  Baseline model = two_columns();
  model.effects = {{"bias_step", {"gx"}, {}, {}}, {"temperature_bias", {}, {}, {}}};
  const auto x = sensor_of_model(model, {.axes = {0}});
  const auto z = sensor_of_model(model, {.axes = {2}});
  ASSERT_TRUE(x && z);
  EXPECT_EQ(x->left_out, (std::vector<std::string>{"bias_step", "temperature_bias"}));
  EXPECT_EQ(z->left_out, std::vector<std::string>{"temperature_bias"});
}

TEST(ModelledSensor, WhatIsSaidOfAllColumnsHoldsForEveryAxis) {
  Baseline model;
  model.processes = white(7e-6);
  const auto made = sensor_of_model(model, {});
  ASSERT_TRUE(made);
  ASSERT_EQ(made->axes.size(), 3);
  for (const ModelledAxis& axis : made->axes) {
    EXPECT_EQ(axis.processes.front().parameters.front(), 7e-6);
  }
}

TEST(ModelledSensor, AsksForTheColumnWhereItIsNotClear) {
  const auto unclear = sensor_of_model(two_columns(), {.axes = {1}});
  ASSERT_FALSE(unclear);
  EXPECT_EQ(unclear.error().code, ErrorCode::InvalidArgument);
  const auto absent = sensor_of_model(two_columns(), {.column = "gq"});
  ASSERT_FALSE(absent);
  EXPECT_EQ(absent.error().code, ErrorCode::NotFound);
  EXPECT_TRUE(absent.error().message.find("'gq'") != std::string::npos) << absent.error().message;
  const auto named = sensor_of_model(two_columns(), {.axes = {1}, .column = "gz"});
  ASSERT_TRUE(named);
  EXPECT_EQ(named->axes[0].bias, 2e-3);
}

TEST(ModelledSensor, RefusesTheModelOfTheOtherSensor) {
  const auto made = sensor_of_model(two_columns(), {.gyro = false, .axes = {0}, .column = "gx"});
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().code, ErrorCode::UnitMismatch);
  EXPECT_EQ(made.error().message, "The model describes a gyroscope, and this is an accelerometer.");
}

}  // namespace
}  // namespace driftlab
