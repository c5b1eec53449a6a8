#include "schema/json/table_schedule.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace driftlab {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

Json cell(double value, const char* unit) {
  return Json{{"value", value}, {"unit", unit}, {"ci95", {0.98 * value, 1.02 * value}}};
}

Json row(Json condition, double n, double sigma, double beta) {
  return Json{{"condition", std::move(condition)},
              {"label", "a row"},
              {"values",
               {{"white_noise.N", cell(n, "deg/sqrt(h)")},
                {"gauss_markov_1.sigma", cell(sigma, "deg/h")},
                {"gauss_markov_1.beta", cell(beta, "1/s")}}},
              {"reasons", Json::object()}};
}

Json at_rate(double deg_s) {
  return Json{{"kind", "constant_rate"}, {"axis", "z"}, {"value", deg_s}, {"unit", "deg/s"}};
}

/// N doubles from rest to 40 deg/s on a straight line; sigma and beta stay.
Json table() {
  Json rows = Json::array();
  rows.push_back(row({{"kind", "static"}}, 1.0, 60.0, 0.1));
  rows.push_back(row(at_rate(10.0), 1.25, 60.0, 0.1));
  rows.push_back(row(at_rate(20.0), 1.5, 60.0, 0.1));
  rows.push_back(row(at_rate(-20.0), 1.5, 60.0, 0.1));
  rows.push_back(row(at_rate(40.0), 2.0, 60.0, 0.1));
  return Json{{"device", "phone"},
              {"sensor", "gyroscope"},
              {"axis", "z"},
              {"method", "gmwm"},
              {"model", "WN+GM"},
              {"columns",
               {{{"key", "white_noise.N"}, {"unit", "deg/sqrt(h)"}},
                {{"key", "gauss_markov_1.sigma"}, {"unit", "deg/h"}},
                {{"key", "gauss_markov_1.beta"}, {"unit", "1/s"}}}},
              {"rows", std::move(rows)}};
}

double n_at(const ModelSchedule& schedule, double deg_s) {
  return schedule.model(schedule.band(deg_s * kDegree))[0].parameters[0] / (kDegree / 60.0);
}

TEST(TableSchedule, SwitchesHalfWayBetweenMeasuredRates) {
  Faults faults;
  const ModelSchedule schedule = schedule_from_table(table(), {}, "", faults);
  ASSERT_TRUE(faults.none()) << faults.error().message;
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
  Faults faults;
  const ModelSchedule schedule = schedule_from_table(table(), options, "", faults);
  ASSERT_TRUE(faults.none()) << faults.error().message;
  // The points lie on a line, so the fitted relation is that line; a band is a degree wide: 0.0125 to its middle.
  for (const double rate : {0.0, 7.0, 15.0, 33.0}) {
    EXPECT_NEAR(n_at(schedule, rate), 1.0 + rate / 40.0, 0.015) << rate;
  }
  EXPECT_NEAR(n_at(schedule, 90.0), 2.0, 0.02) << "beyond the measured rates the last one holds";
  EXPECT_NEAR(schedule.model(schedule.band(30.0 * kDegree))[1].parameters[1], 0.1, 1e-3);
}

TEST(TableSchedule, AllanTablesGiveWhiteNoise) {
  Json allan = table();
  allan["method"] = "av";
  allan["columns"] = Json::array({Json{{"key", "N"}, {"unit", "deg/sqrt(h)"}}, Json{{"key", "B"}, {"unit", "deg/h"}}});
  for (Json& each : allan["rows"]) {
    each["values"] = Json{{"N", cell(1.5, "deg/sqrt(h)")}, {"B", nullptr}};
  }
  Faults faults;
  const ModelSchedule schedule = schedule_from_table(allan, {}, "", faults);
  ASSERT_TRUE(faults.none()) << faults.error().message;
  ASSERT_EQ(schedule.model(0).size(), 1U);
  EXPECT_NEAR(n_at(schedule, 20.0), 1.5, 1e-12);
}

TEST(TableSchedule, RowsThatDoNotTellAreLeftOutAndAnEmptyRestIsAFault) {
  Json partial = table();
  partial["rows"][1]["values"]["gauss_markov_1.beta"] = nullptr;
  Faults faults;
  EXPECT_EQ(schedule_from_table(partial, {}, "", faults).size(), 3U);
  EXPECT_TRUE(faults.none());
  partial["rows"] = Json::array();
  (void)schedule_from_table(partial, {}, "/table", faults);
  EXPECT_FALSE(faults.none());
  Faults other;
  (void)schedule_from_table(Json{{"rows", Json::array()}}, {}, "/table", other);
  EXPECT_FALSE(other.none());
}

}  // namespace
}  // namespace driftlab
