// What the files of a drive say in several ways is the same drive.
#include "tests/unit/navigate/drive_files.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace driftlab::drive {
namespace {

TEST(DriveInput, OneFileOfSeveralStreamsIsTheDriveOfAFileForEach) {
  Files apart = town();
  Files together = town();
  in_one_file(together);
  const auto a = load_drive(apart.document, apart.tables);
  const auto b = load_drive(together.document, together.tables);
  ASSERT_TRUE(a && b);
  ASSERT_EQ(a->fixes.size(), b->fixes.size());
  for (std::size_t i = 0; i < a->fixes.size(); ++i) {
    EXPECT_EQ(a->fixes[i].time_s, b->fixes[i].time_s);
    EXPECT_EQ(a->fixes[i].position_ecef_m, b->fixes[i].position_ecef_m);
  }
  EXPECT_EQ(a->runs.front().readings, b->runs.front().readings);
  EXPECT_EQ(b->facts.gnss_stamps.rows, a->facts.gnss_stamps.rows);
  EXPECT_EQ(b->facts.gnss_stamps.without_stamp, 0U) << "rows behind the last fix are no rows without a stamp";
}

TEST(DriveInput, ANumberThatStandsForNoneIsARowLeftOutAndNoReading) {
  // -9999 rad/s on one axis for one sample would turn the vehicle by a hundred radians.
  Files gap = town();
  Files sentinel = town();
  gap.imu("gz")[500] = kNothing;
  sentinel.imu("gz")[500] = -9999.0;
  const auto a = load_drive(gap.document, gap.tables);
  const auto b = load_drive(sentinel.document, sentinel.tables);
  ASSERT_TRUE(a && b);
  EXPECT_EQ(a->runs.front().readings, b->runs.front().readings);
  EXPECT_EQ(b->facts.sampling.incomplete, 1U);
}

TEST(DriveInput, AFileThatHoldsItsFixesIsTheDriveOfTheFixes) {
  // Each fix five times, at the unit's rate, without a word of it in the document: taken as new data they would count
  // five times, the last 40 ms too late.
  const Files once = town();
  Files held = town();
  hold_each(held, 5);
  const auto a = load_drive(once.document, once.tables);
  const auto b = load_drive(held.document, held.tables);
  ASSERT_TRUE(a && b);
  ASSERT_EQ(a->fixes.size(), b->fixes.size());
  for (std::size_t i = 0; i < a->fixes.size(); ++i) {
    EXPECT_EQ(a->fixes[i].time_s, b->fixes[i].time_s);
    EXPECT_EQ(a->fixes[i].position_ecef_m, b->fixes[i].position_ecef_m);
  }
  EXPECT_EQ(b->facts.held, 4 * a->fixes.size());
  std::vector<double>& heights = held.gnss("h");
  for (std::size_t row = 0; row < heights.size(); ++row) {
    heights[row] += row % 5 >= 3 ? 0.1 : 0.0;  // stated later than the place, as a car's logger does
  }
  const auto twice = load_drive(held.document, held.tables);
  ASSERT_TRUE(twice);
  EXPECT_EQ(twice->facts.held, b->facts.held) << "a new height is no new place";
  held.gnss("h").assign(held.gnss("h").size(), kNothing);
  const auto flat = load_drive(held.document, held.tables);
  ASSERT_TRUE(flat);
  EXPECT_EQ(flat->facts.held, b->facts.held) << "a height that is missing is no new fix";
}

TEST(DriveInput, AReceiverAtRestThatRepeatsItselfHoldsNothing) {
  Files files = town();
  const std::size_t rows = files.tables.gnss.rows();
  for (std::size_t row = 1; row < rows; ++row) {
    const bool still = std::hypot(files.gnss("vn")[row], files.gnss("ve")[row]) < 0.5;
    for (std::size_t c = 1; still && c < files.tables.gnss.columns.size(); ++c) {
      files.tables.gnss.columns[c][row] = files.tables.gnss.columns[c][row - 1];
    }
  }
  const auto drive = load_drive(files.document, files.tables);
  ASSERT_TRUE(drive) << drive.error().message;
  EXPECT_EQ(drive->facts.held, 0U);
  EXPECT_EQ(drive->fixes.size(), rows);
}

TEST(DriveInput, PositionsAloneShowSpeedAndLengthOfTheDrive) {
  // A receiver without velocities was said never to move faster than 3 m/s, over 0 m.
  Files files = town();
  for (const char* name : {"vn", "ve", "vd"}) {
    files.document.gnss.source.columns.erase(name);
  }
  const auto whole = load_drive(town().document, town().tables);
  const auto drive = load_drive(files.document, files.tables);
  ASSERT_TRUE(whole && drive);
  EXPECT_NEAR(drive->facts.length_m, whole->facts.length_m, 0.05 * whole->facts.length_m);
  EXPECT_NEAR(drive->facts.highest_speed_m_s, whole->facts.highest_speed_m_s, 1.0);
}

TEST(DriveInput, AnOdometerIsReadBySpeedOrByTicks) {
  Files files = town();
  OdometerSource& odometer = files.document.odometer.emplace();
  odometer.source.file = "wheel.csv";
  odometer.source.time.column = "t";
  odometer.source.columns = {{"v", {Quantity::OdometerSpeed, "", 1.0 / 3.6}}};
  Table wheel{{"t", "v", "n"}, {{1.0, 1.5, 2.0}, {36.0, 72.0, kNothing}, {0.0, 100.0, 300.0}}, {}, {}};
  files.tables.odometer = wheel;
  const auto by_speed = load_drive(files.document, files.tables);
  ASSERT_TRUE(by_speed) << by_speed.error().message;
  const double zero = by_speed->epoch_s;
  ASSERT_EQ(by_speed->odometer.size(), 2U) << "a row without a number is none";
  EXPECT_NEAR(by_speed->odometer[0].speed_m_s, 10.0, 1e-12);
  EXPECT_NEAR(by_speed->odometer[1].speed_m_s, 20.0, 1e-12);
  EXPECT_NEAR(by_speed->odometer[1].time_s, 1.5 - zero, 1e-9);
  odometer.source.columns = {{"n", {Quantity::OdometerTicks, "", 1.0}}};
  const auto without_length = load_drive(files.document, files.tables);
  ASSERT_FALSE(without_length);
  EXPECT_NE(without_length.error().message.find("metres_per_tick"), std::string::npos);
  odometer.metres_per_tick = 0.02;
  const auto by_ticks = load_drive(files.document, files.tables);
  ASSERT_TRUE(by_ticks);
  ASSERT_EQ(by_ticks->odometer.size(), 2U);
  EXPECT_NEAR(by_ticks->odometer[0].speed_m_s, 0.02 * 100.0 / 0.5, 1e-12);
  EXPECT_NEAR(by_ticks->odometer[0].time_s, 1.25 - zero, 1e-9) << "the mean speed between two counts";
  EXPECT_NEAR(by_ticks->odometer[1].speed_m_s, 0.02 * 200.0 / 0.5, 1e-12);
}

TEST(DriveInput, StampsOfArrivalGetEqualSpacing) {
  // Every second reading arrives a millisecond late: taken at their stamps, readings would be mixed with their
  // neighbours on the even grid.
  Files files = town();
  std::vector<double>& t = files.imu("t");
  for (std::size_t i = 0; i < t.size(); i += 2) {
    t[i] += 0.001;
  }
  files.document.imu.source.time.arrival = true;
  const auto drive = load_drive(files.document, files.tables);
  ASSERT_TRUE(drive) << drive.error().message;
  ASSERT_EQ(drive->runs.size(), 1U);
  EXPECT_NEAR(static_cast<double>(drive->runs.front().readings.size()), static_cast<double>(t.size()), 3.0);
  EXPECT_EQ(drive->runs.front().readings[1001][2], files.imu("gz")[1001]) << "each reading is one of the file";
}

TEST(DriveInput, StampsOfArrivalGetEqualSpacingBesideAGapThatIsBridged) {
  // Every second reading arrives a millisecond late, but for the first, and one of the late ones is lost. Taken at
  // their stamps, readings would be mixed with their neighbours by a tenth of the difference.
  Files files = town();
  std::vector<double>& t = files.imu("t");
  for (std::size_t i = 2; i < t.size(); i += 2) {
    t[i] += 0.001;
  }
  const std::size_t lost = 20000;
  files.imu("gz")[lost] = kNothing;
  files.document.imu.source.time.arrival = true;
  const auto drive = load_drive(files.document, files.tables);
  ASSERT_TRUE(drive) << drive.error().message;
  ASSERT_EQ(drive->runs.size(), 1U);
  EXPECT_EQ(drive->facts.sampling.samples_bridged, 1U);
  const std::vector<ImuSample>& readings = drive->runs.front().readings;
  ASSERT_EQ(readings.size(), t.size());
  double mixed = 0.0;
  double changes = 0.0;
  for (std::size_t i = 1; i < t.size(); ++i) {
    const bool near = i >= lost - 2 && i <= lost + 2;
    mixed += near ? 0.0 : std::abs(readings[i][2] - files.imu("gz")[i]);
    changes += near ? 0.0 : std::abs(files.imu("gz")[i] - files.imu("gz")[i - 1]);
  }
  EXPECT_LT(mixed, 1e-3 * changes);
}

TEST(DriveInput, SpeedAndCourseOfZeroIsRestAndNoHeading) {
  Files files = town();
  by_course(files);
  const auto drive = load_drive(files.document, files.tables);
  ASSERT_TRUE(drive) << drive.error().message;
  std::size_t resting = 0;
  for (const Fix& fix : drive->fixes) {
    ASSERT_TRUE(fix.velocity_ned_m_s);
    if (fix.velocity_ned_m_s->head<2>().norm() == 0.0) {
      ++resting;
      EXPECT_FALSE(fix.has_course);
      EXPECT_GE(fix.velocity_sd_m_s.x(), 0.5);
    }
  }
  EXPECT_GT(resting, 50U);
}

}  // namespace
}  // namespace driftlab::drive
