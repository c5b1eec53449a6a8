#include "core/signal/recording_columns.hpp"

#include "core/signal/missing.hpp"
#include "core/signal/no_rate.hpp"

#include <gtest/gtest.h>

namespace driftlab {
namespace {

const std::vector<double> kBlank(4, 0.0);

RecordingColumns columns_of(const std::map<std::string, ColumnRole>& roles,
                            const std::vector<double>& samples = kBlank) {
  RecordingSpec spec;
  spec.columns = roles;
  ColumnNames names;
  for (const auto& [name, role] : roles) {
    names.push_back(name);
  }
  return RecordingColumns::read(spec, names, [&](std::size_t) { return std::span<const double>(samples); }).value();
}

TEST(RecordingColumns, PreferAReferenceRateToAnAngle) {
  const RecordingColumns both = columns_of({{"a", {Quantity::ReferenceAngle, "z", *parse_unit("deg")}},
                                            {"g", {Quantity::AngularRate, "z", *parse_unit("deg/s")}},
                                            {"r", {Quantity::ReferenceAngularRate, "z", *parse_unit("deg/s")}}});
  const auto source = both.reference_of(Quantity::AngularRate, "z");
  ASSERT_TRUE(source);
  EXPECT_EQ(both.name(source->index), "r");
  EXPECT_FALSE(source->angle);
  EXPECT_FALSE(both.reference_of(Quantity::AngularRate, "x"));
  EXPECT_FALSE(both.reference_of(Quantity::SpecificForce, "z"));
  EXPECT_FALSE(both.reference_of(Quantity::Temperature, ""));
}

TEST(RecordingColumns, TakeTheAngleWhereThereIsNoRate) {
  const std::vector<double> half_a_turn{180.0};
  const RecordingColumns one = columns_of({{"a", {Quantity::ReferenceAngle, "z", *parse_unit("deg")}}}, half_a_turn);
  const auto source = one.reference_of(Quantity::AngularRate, "z");
  ASSERT_TRUE(source);
  EXPECT_TRUE(source->angle);
  EXPECT_DOUBLE_EQ(one.si(source->index)[0], 3.14159265358979323846);
}

TEST(RecordingColumns, TimeOfTextIsNoTimeUnlessItWasStated) {
  const std::vector<double> text{missing_sample(Missing::Text, 1)};
  const auto samples = [&](std::size_t) { return std::span<const double>(text); };
  const auto guessed = RecordingColumns::read({}, {"time", "gz"}, samples);
  ASSERT_TRUE(guessed);
  EXPECT_FALSE(guessed->time());
  EXPECT_NE(guessed->note_of_time().find("'time' holds text"), std::string::npos);
  EXPECT_EQ(guessed->time_of_text(), "time");
  const Error refusal = neither_time_nor_rate(guessed->guessed_time(), guessed->time_of_text()).value();
  EXPECT_EQ(refusal.message.find("The cells of column 'time' are text that is not read as time"), 0U);
  EXPECT_NE(refusal.message.find("give rate_hz"), std::string::npos);
  EXPECT_NE(refusal.message.find("23:59:50.5"), std::string::npos);
  RecordingSpec spec;
  spec.columns["time"] = {Quantity::Time, "", *parse_unit("s")};
  const auto stated = RecordingColumns::read(spec, {"time"}, samples);
  ASSERT_TRUE(stated);
  EXPECT_TRUE(stated->time());
  EXPECT_EQ(stated->note_of_time(), "");
}

TEST(RecordingColumns, ATimeByItsNameServesWhereTheStatedColumnsHaveNone) {
  // `--columns` with six axes of a MATLAB file lost the time that its stated rate had given.
  const std::vector<double> zero{0.0};
  const auto samples = [&](std::size_t) { return std::span<const double>(zero); };
  RecordingSpec spec;
  spec.columns["gz"] = {Quantity::AngularRate, "z", *parse_unit("deg/s")};
  const auto found = RecordingColumns::read(spec, {"gz", "time (s)", "counter"}, samples);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->time(), std::optional<std::size_t>(1));
  EXPECT_EQ(found->find(Quantity::AngularRate, "z"), std::optional<std::size_t>(0));
  EXPECT_EQ(found->unit(0).symbol, "deg/s");
  EXPECT_EQ(found->note_of_time(), "No column is stated to be the time; 'time (s)' is taken for it by its name.");
  EXPECT_FALSE(RecordingColumns::read(spec, {"gz", "time (s)", "t (ms)"}, samples)->time()) << "which of the two?";
  EXPECT_FALSE(RecordingColumns::read(spec, {"gz", "time"}, samples)->time()) << "in which unit?";
  spec.rate_hz = 100.0;
  EXPECT_FALSE(RecordingColumns::read(spec, {"gz", "time (s)"}, samples)->time()) << "the rate is the time base";
}

TEST(RecordingColumns, TheLengthOfAVectorBesideItsAxesIsPassedOver) {
  const auto samples = [](std::size_t) { return std::span<const double>(kBlank); };
  const auto columns =
      RecordingColumns::read({}, {"Acceleration x (m/s^2)", "Absolute acceleration (m/s^2)", "acc_l_x"}, samples);
  ASSERT_TRUE(columns);
  EXPECT_FALSE(columns->use_of(1)->examined);
  EXPECT_TRUE(columns->use_of(2)->examined) << "which axis it is, its name does not say";
}

TEST(RecordingColumns, WhatALogKeepsBesideTheSamplesOfASensorIsPassedOver) {
  // PX4's ulog2csv: intervals and relative stamps were characterised as sensors in unit 1.
  const auto samples = [](std::size_t) { return std::span<const double>(kBlank); };
  const ColumnNames beside{"gyro_integral_dt",
                           "accelerometer_timestamp_relative",
                           "accelerometer_integral_dt",
                           "gyro_clipping",
                           "accel_count",
                           "gyro_x_var",
                           "gyro_z_temp",
                           "loggingSample(N)",
                           "gyroTempRaw"};
  ColumnNames names{"gyro_rad[0]"};
  names.insert(names.end(), beside.begin(), beside.end());
  const auto columns = RecordingColumns::read({}, names, samples);
  ASSERT_TRUE(columns) << columns.error().message;
  for (std::size_t i = 1; i < names.size(); ++i) {
    EXPECT_FALSE(columns->use_of(i)->examined) << names[i];
    EXPECT_NE(columns->note_of_skipped().find("'" + names[i] + "'"), std::string::npos) << names[i];
  }
  // What may be the samples themselves is not.
  const auto raw = RecordingColumns::read({}, {"gyro_rad[0]", "gyro_x_count", "acc_l_x (count)", "gyro"}, samples);
  ASSERT_TRUE(raw) << raw.error().message;
  EXPECT_EQ(raw->note_of_skipped(), "");
  EXPECT_TRUE(raw->use_of(1)->examined);
}

TEST(RecordingColumns, SayThatTheUnitOfATemperatureIsNotKnown) {
  const auto samples = [](std::size_t) { return std::span<const double>(kBlank); };
  const auto columns = RecordingColumns::read({}, {"gx (deg/s)", "temp (F)"}, samples);
  ASSERT_TRUE(columns);
  const auto use = columns->use_of(1);
  EXPECT_FALSE(use->examined);
  EXPECT_EQ(use->note, "The unit 'F' of column 'temp (F)' is not known; it counts as not stated.");
  const auto known = RecordingColumns::read({}, {"gx (deg/s)", "temp (C)"}, samples);
  EXPECT_EQ(known->use_of(1)->note, "");
}

TEST(RecordingColumns, DoNotSayThatAUnitIsNotStatedWhereItIs) {
  const auto samples = [](std::size_t) { return std::span<const double>(kBlank); };
  const auto columns = RecordingColumns::read({}, {"acc_l_x [mg]", "acc_l_y", "acc_l_z [LSB]"}, samples);
  ASSERT_TRUE(columns);
  EXPECT_EQ(
      columns->use_of(0)->note,
      "The name of column 'acc_l_x [mg]' does not say which sensor and axis it is, so its unit is not read and is "
      "1.");
  EXPECT_EQ(columns->use_of(1)->note, "The unit of column 'acc_l_y' is not stated; its unit is 1.");
  EXPECT_EQ(columns->use_of(2)->note, "The unit of column 'acc_l_z [LSB]' is not stated; its unit is 1.");
}

TEST(RecordingColumns, NameAUnitThatIsNotUnderstood) {
  // "The unit of column 'motionUserAccelerationX(G)' is not stated".
  const auto samples = [](std::size_t) { return std::span<const double>(kBlank); };
  const auto columns = RecordingColumns::read(
      {}, {"motionUserAccelerationX(G)", "acc_l_x [furlong]", "gyro[7]", "acc_l_y (raw)"}, samples);
  ASSERT_TRUE(columns) << columns.error().message;
  EXPECT_EQ(columns->use_of(0)->note,
            "The unit 'G' of column 'motionUserAccelerationX(G)' is not understood; its unit is 1.");
  EXPECT_EQ(columns->use_of(1)->note,
            "The unit 'furlong' of column 'acc_l_x [furlong]' is not understood; its unit is 1.");
  EXPECT_EQ(columns->use_of(2)->note, "The unit of column 'gyro[7]' is not stated; its unit is 1.");
  EXPECT_EQ(columns->use_of(3)->note, "The unit of column 'acc_l_y (raw)' is not stated; its unit is 1.");
}

TEST(StatedRate, IsTheConditionsOwn) {
  EXPECT_EQ(stated_rate(*parse_condition("static"), "z", 5.0), 0.0);
  const Condition turning = *parse_condition("constant_rate:z:9:rad/s");
  EXPECT_EQ(stated_rate(turning, "z", 5.0), 9.0);
  EXPECT_EQ(stated_rate(turning, "x", 5.0), 0.0);
  const Condition ramp = *parse_condition("constant_angular_acceleration:z:2:deg/s^2");
  EXPECT_EQ(stated_rate(ramp, "z", 5.0), *ramp.value * 5.0);
}

}  // namespace
}  // namespace driftlab
