/// Satellite fixes and odometers of the logs of robots and flight controllers, beside the inertial stream of the same
/// file.
#include "core/signal/missing.hpp"
#include "tests/unit/read/samples.hpp"

#include <gmock/gmock.h>

#include <cmath>

namespace driftlab {
namespace {

using namespace driftlab::testing;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// The values of a column by its name, up to where it has ended.
std::vector<double> named(const Outcome& outcome, const std::string& name) {
  std::vector<double> values;
  const auto found = std::find(outcome.decoded.names.begin(), outcome.decoded.names.end(), name);
  EXPECT_NE(found, outcome.decoded.names.end()) << name;
  for (std::size_t row = 0; found != outcome.decoded.names.end() && row < outcome.decoded.rows; ++row) {
    const double value = cell(outcome, static_cast<std::size_t>(found - outcome.decoded.names.begin()), row);
    if (!std::isnan(value) || why_missing(value).why != Missing::Ended) {
      values.push_back(value);
    }
  }
  return values;
}

TEST(BesideStreams, FixesAndOdometryStandInColumnsOfTheirOwnOnTheSameClock) {
  const Outcome outcome = decode_bytes(journey_bag());
  ASSERT_FALSE(outcome.error) << outcome.message;
  EXPECT_EQ(outcome.decoded.rows, 40U);
  EXPECT_THAT(named(outcome, "time (s)").back(), 0.2);
  EXPECT_THAT(named(outcome, "gnss_time (s)"), ElementsAre(-0.02, 0.08)) << "the zero is that of the inertial stream";
  EXPECT_THAT(named(outcome, "gnss_status"), ElementsAre(1.0, 1.0));
  EXPECT_THAT(named(outcome, "gnss_latitude (deg)"), ElementsAre(50.5, 50.75));
  EXPECT_THAT(named(outcome, "gnss_longitude (deg)"), ElementsAre(13.25, 13.5));
  EXPECT_THAT(named(outcome, "gnss_height (m)"), ElementsAre(250.0, 251.0));
  EXPECT_THAT(named(outcome, "gnss_sd_east (m)"), ElementsAre(0.5, 0.5));
  EXPECT_THAT(named(outcome, "gnss_sd_north (m)"), ElementsAre(0.25, 0.25));
  EXPECT_THAT(named(outcome, "gnss_sd_up (m)"), ElementsAre(2.0, 2.0));
  EXPECT_THAT(named(outcome, "odometry_time (s)"), ElementsAre(0.0, 0.05, 0.1));
  EXPECT_THAT(named(outcome, "odometry_position_x (m)"), ElementsAre(2.0, 4.0, 6.0));
  EXPECT_THAT(named(outcome, "odometry_velocity_x (m/s)"), ElementsAre(1.0, 2.0, 3.0));
  EXPECT_THAT(named(outcome, "odometry_rate_z (rad/s)"), ElementsAre(-0.125, -0.125, -0.125));
  EXPECT_THAT(outcome.decoded.notes, Contains(HasSubstr("'/fix' (gnss_, 2 rows), '/odom' (odometry_, 3 rows)")));
}

TEST(BesideStreams, TheSameJourneyReadsTheSameInEveryFormatOfRos) {
  const Outcome bag = decode_bytes(journey_bag());
  for (const std::string& file : {journey_mcap(), journey_bag2()}) {
    const Outcome other = decode_bytes(file);
    ASSERT_FALSE(other.error) << other.message;
    EXPECT_EQ(other.decoded.names, bag.decoded.names);
    EXPECT_EQ(other.bits, bag.bits);
  }
}

TEST(BesideStreams, InertialColumnsAreThoseOfAFileWithoutThem) {
  const Outcome with = decode_bytes(journey_bag());
  const Outcome without = decode_bytes(rosbag(inertial_rows(40)));
  ASSERT_FALSE(with.error || without.error);
  for (std::size_t column = 0; column < without.bits.size(); ++column) {
    EXPECT_EQ(with.decoded.names[column], without.decoded.names[column]);
    EXPECT_EQ(with.bits[column], without.bits[column]);
  }
}

TEST(BesideStreams, AFileOfFixesAloneIsATableOfThem) {
  const std::string records = bag_connection(1, "/fix", "sensor_msgs/NavSatFix") +
                              bag_message(1, 5, ros1_fix({kStart + 1'000'000})) +
                              bag_message(1, 6, ros1_fix({kStart + 1'250'000}, 0));
  const Outcome outcome = decode_bytes(bag_front() + records);
  ASSERT_FALSE(outcome.error) << outcome.message;
  EXPECT_EQ(outcome.decoded.rows, 2U);
  EXPECT_THAT(named(outcome, "gnss_time (s)"), ElementsAre(0.0, 0.25));
  EXPECT_EQ(named(outcome, "gnss_sd_up (m)")[0], 2.0);
  EXPECT_TRUE(std::isnan(named(outcome, "gnss_sd_up (m)")[1])) << "of a covariance that is not known";
}

TEST(BesideStreams, WhatIsLongerThanTheInertialStreamIsCutAndSaid) {
  std::string records =
      bag_connection(0, "/imu", "sensor_msgs/Imu") + bag_connection(1, "/fix", "sensor_msgs/NavSatFix");
  for (const InertialRow& row : inertial_rows(2)) {
    records += bag_message(0, row.time_us, ros1_imu(row));
  }
  for (std::uint64_t i = 0; i < 5; ++i) {
    records += bag_message(1, 1, ros1_fix({kStart + 1000 * i}));
  }
  const Outcome outcome = decode_bytes(bag_front() + records);
  ASSERT_FALSE(outcome.error) << outcome.message;
  EXPECT_EQ(outcome.decoded.rows, 2U);
  EXPECT_EQ(named(outcome, "gnss_time (s)").size(), 2U);
  EXPECT_THAT(outcome.decoded.notes, Contains(HasSubstr("Of '/fix' the last 3 rows are left out.")));
}

TEST(BesideStreams, ATornFixIsLeftOutAndCounted) {
  const std::string fix = ros1_fix({kStart});
  const std::string bag = bag_front() + bag_connection(0, "/imu", "sensor_msgs/Imu") +
                          bag_connection(1, "/fix", "sensor_msgs/NavSatFix") +
                          bag_message(0, 1, ros1_imu(inertial_rows()[0])) + bag_message(1, 1, fix) +
                          bag_message(1, 1, fix.substr(0, fix.size() - 1));
  const Outcome outcome = decode_bytes(bag);
  ASSERT_FALSE(outcome.error) << outcome.message;
  EXPECT_EQ(named(outcome, "gnss_time (s)").size(), 1U);
  EXPECT_THAT(outcome.decoded.notes, Contains("1 message cannot be read and is left out."));
}

/// Both receivers of a log say these values in their first row, of so many.
void expect_of_both_receivers(const Outcome& outcome, const std::vector<std::pair<std::string, double>>& expected,
                              std::size_t rows) {
  for (const auto& [column, value] : expected) {
    for (const std::string receiver : {"gnss_", "gnss2_"}) {
      const std::vector<double> found = named(outcome, receiver + column);
      ASSERT_EQ(found.size(), rows) << receiver << column;
      EXPECT_NEAR(found[0], value, 1e-14 * std::abs(value)) << receiver << column;
    }
  }
}

TEST(BesideStreams, AULogsReceiverReadsTheSameInBothLayoutsOfPx4) {
  const std::string tail = floats({0.25F, 0.5F, 0.75F, 1.5F, -2.5F, 0.125F}) + word(3, 1) + word(11, 1);
  const auto whole = [](std::int32_t value) { return bytes_of(value); };
  std::string file = ulog_front() + ulog_topic(kSensorCombined) + ulog_topic(kOldFix, 8) + ulog_topic(kNewFix, 9);
  const std::vector<InertialRow> rows = inertial_rows(4);
  for (const InertialRow& row : rows) {
    file += ulog_sample(row);
  }
  file += ulog_message('D', word(8, 2) + word(rows[0].time_us + 500, 8) + word(1'600'000'000'500'000U, 8) +
                                whole(473977419) + whole(85455939) + whole(488500) + whole(535250) + tail);
  file += ulog_message('D', word(9, 2) + word(7, 8) + word(rows[0].time_us + 500, 8) +
                                numbers_of({47.3977419, 8.5455939, 488.5, 535.25}) + word(1'600'000'000'500'000U, 8) +
                                tail);
  file += ulog_message('D', word(9, 2) + word(7, 8));
  const Outcome outcome = decode_bytes(file);
  ASSERT_FALSE(outcome.error) << outcome.message;
  const std::vector<std::pair<std::string, double>> expected{
      {"time (s)", 0.0005},          {"latitude (deg)", 47.3977419}, {"longitude (deg)", 8.5455939},
      {"height (m)", 535.25},        {"altitude (m)", 488.5},        {"velocity_north (m/s)", 1.5},
      {"velocity_east (m/s)", -2.5}, {"velocity_down (m/s)", 0.125}, {"sd_horizontal (m)", 0.5},
      {"sd_vertical (m)", 0.75},     {"sd_speed (m/s)", 0.25},       {"fix_type", 3.0},
      {"satellites", 11.0},          {"utc (s)", 1'600'000'000.5}};
  expect_of_both_receivers(outcome, expected, 1);
  EXPECT_THAT(outcome.decoded.notes, Contains(HasSubstr("1 data message is shorter than its format")));
}

TEST(BesideStreams, AnArduPilotLogsReceiversStandBesideItsImu) {
  std::string file = dataflash_front() + dataflash_gps();
  for (const InertialRow& row : inertial_rows(4)) {
    file += dataflash_sample(row) + dataflash_fix(row.time_us + 250, 0) + dataflash_fix(row.time_us + 250, 1);
  }
  const Outcome outcome = decode_bytes(file);
  ASSERT_FALSE(outcome.error) << outcome.message;
  const std::vector<std::pair<std::string, double>> expected{{"time (s)", 0.00025},
                                                             {"latitude (deg)", -35.3632621},
                                                             {"longitude (deg)", 149.16523},
                                                             {"altitude (m)", 584.12},
                                                             {"speed (m/s)", 12.5},
                                                             {"course (deg)", 271.25},
                                                             {"velocity_down (m/s)", -0.5},
                                                             {"fix_type", 3.0},
                                                             {"satellites", 12.0},
                                                             {"week", 2270.0},
                                                             {"time_of_week (ms)", 345'600'200.0}};
  expect_of_both_receivers(outcome, expected, 4);
  EXPECT_THAT(outcome.decoded.notes, Contains(HasSubstr("'GPS 0' (gnss_, 4 rows), 'GPS 1' (gnss2_, 4 rows)")));
}

TEST(BesideStreams, AReceiverThatComesWhenTheTableHasBegunIsLeftOutAndSaid) {
  const std::string fix_tail = floats({0.25F, 0.5F, 0.75F, 1.5F, -2.5F, 0.125F}) + word(3, 1) + word(11, 1);
  std::string file = ulog_front() + ulog_topic(kSensorCombined) + ulog_topic(kOldFix, 8);
  const InertialRow row = inertial_rows(1)[0];
  for (int i = 0; i < 310'000; ++i) {  // above 16 MiB of samples
    file += ulog_sample(row);
  }
  file += ulog_message('D', word(8, 2) + word(row.time_us, 8) + std::string(24, '\0') + fix_tail);
  const Outcome outcome = decode_bytes(file);
  ASSERT_FALSE(outcome.error) << outcome.message;
  EXPECT_EQ(outcome.decoded.names.size(), 7U);
  EXPECT_THAT(outcome.decoded.notes, Contains(HasSubstr("Of 'vehicle_gps_position 0' the last 1 row is left out.")));
}

}  // namespace
}  // namespace driftlab
