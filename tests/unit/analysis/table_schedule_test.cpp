#include "core/analysis/table_schedule.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace driftlab {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

ReportedValue cell(double value, const char* unit) { return {value, 0.98 * value, 1.02 * value, unit, ""}; }

TableRow row(const char* condition, double n, double sigma, double beta) {
  TableRow made;
  made.condition = *parse_condition(condition);
  made.cells = {{cell(n, "deg/sqrt(h)"), {}}, {cell(sigma, "deg/h"), {}}, {cell(beta, "1/s"), {}}};
  return made;
}

/// N doubles from rest to 40 deg/s on a straight line; sigma and beta stay.
ParameterTable table() {
  ParameterTable made{"phone", Quantity::AngularRate, "z", TableMethod::Gmwm, "WN+GM", {}, {}};
  made.columns = {{"white_noise.N", "deg/sqrt(h)"}, {"gauss_markov_1.sigma", "deg/h"}, {"gauss_markov_1.beta", "1/s"}};
  made.rows = {row("static", 1.0, 60.0, 0.1), row("constant_rate:z:10:deg/s", 1.25, 60.0, 0.1),
               row("constant_rate:z:20:deg/s", 1.5, 60.0, 0.1), row("constant_rate:z:-20:deg/s", 1.5, 60.0, 0.1),
               row("constant_rate:z:40:deg/s", 2.0, 60.0, 0.1)};
  return made;
}

double n_at(const ModelSchedule& schedule, double deg_s) {
  return schedule.model(schedule.band(deg_s * kDegree))[0].parameters[0] / (kDegree / 60.0);
}

TEST(TableSchedule, SwitchesHalfWayBetweenMeasuredRates) {
  const ModelSchedule schedule = *schedule_from_table(table(), {});
  ASSERT_EQ(schedule.size(), 4U);
  EXPECT_NEAR(schedule.bounds_rad_s()[0], 5.0 * kDegree, 1e-12);
  EXPECT_NEAR(schedule.bounds_rad_s()[2], 30.0 * kDegree, 1e-12);
  EXPECT_NEAR(n_at(schedule, 4.0), 1.0, 1e-12);
  EXPECT_NEAR(n_at(schedule, -17.0), 1.5, 1e-12) << "+20 and -20 deg/s are one rate";
  EXPECT_NEAR(n_at(schedule, 100.0), 2.0, 1e-12);
  EXPECT_EQ(schedule.model(0)[1].kind->name, "gauss_markov");
  EXPECT_NEAR(schedule.model(0)[1].parameters[0], 60.0 * kDegree / 3600.0, 1e-15);
  EXPECT_NEAR(schedule.model(0)[1].parameters[1], 0.1, 1e-15);
}

TEST(TableSchedule, FollowsTheTrendOfEveryParameter) {
  TableScheduleOptions options;
  options.continuous = true;
  options.step_rad_s = 1.0 * kDegree;
  const ModelSchedule schedule = *schedule_from_table(table(), options);
  // The points lie on a line, so the fitted relation is that line; a band is a degree wide: 0.0125 to its middle.
  for (const double rate : {0.0, 7.0, 15.0, 33.0}) {
    EXPECT_NEAR(n_at(schedule, rate), 1.0 + rate / 40.0, 0.015) << rate;
  }
  EXPECT_NEAR(n_at(schedule, 90.0), 2.0, 0.02) << "beyond the measured rates the last one holds";
  EXPECT_NEAR(schedule.model(schedule.band(30.0 * kDegree))[1].parameters[1], 0.1, 1e-3);
}

TEST(TableSchedule, AllanTablesGiveWhiteNoise) {
  ParameterTable allan = table();
  allan.method = TableMethod::Av;
  allan.columns = {{"N", "deg/sqrt(h)"}, {"B", "deg/h"}};
  for (TableRow& each : allan.rows) {
    each.cells = {{cell(1.5, "deg/sqrt(h)"), {}}, {}};
  }
  const ModelSchedule schedule = *schedule_from_table(allan, {});
  ASSERT_EQ(schedule.model(0).size(), 1U);
  EXPECT_NEAR(n_at(schedule, 20.0), 1.5, 1e-12);
}

TEST(TableSchedule, RowsThatDoNotTellAreLeftOutAndAnEmptyRestIsAFault) {
  ParameterTable partial = table();
  partial.rows[1].cells[2].estimate = {};
  EXPECT_EQ(schedule_from_table(partial, {})->size(), 3U);
  partial.rows.clear();
  EXPECT_EQ(schedule_from_table(partial, {}).error().code, ErrorCode::InvalidArgument);
}

TEST(TableSchedule, RefusesATableThatIsNoGyroscopes) {
  ParameterTable accelerometer = table();
  accelerometer.columns[0].unit = "ug/sqrt(Hz)";
  EXPECT_EQ(schedule_from_table(accelerometer, {}).error().message, "This is no parameter table of a gyroscope.");
  EXPECT_FALSE(schedule_from_table(ParameterTable{}, {}));
}

}  // namespace
}  // namespace driftlab
