#include "core/analysis/draft_drive.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

namespace driftlab {
namespace {

DraftFile flight_log() {
  return {"flight.ulg",
          "ulog",
          {"time (s)", "gyro_x (rad/s)", "gyro_y (rad/s)", "gyro_z (rad/s)", "acc_x (m/s^2)", "acc_y (m/s^2)",
           "acc_z (m/s^2)", "gnss_time (s)", "gnss_latitude (deg)", "gnss_longitude (deg)", "gnss_height (m)",
           "gnss_altitude (m)", "gnss_velocity_north (m/s)", "gnss_velocity_east (m/s)", "gnss_velocity_down (m/s)",
           "gnss_sd_horizontal (m)", "gnss_fix_type", "gnss2_time (s)", "gnss2_latitude (deg)"},
          {}};
}

std::string told(const DraftSource& source, drive::Quantity quantity, const std::string& axis) {
  for (const DraftColumn& column : source.columns) {
    if (column.quantity == quantity && column.axis == axis) {
      return column.name + " in " + column.unit;
    }
  }
  return "none";
}

bool notes_say(const DriveDraft& draft, const std::string& words) {
  return std::any_of(draft.notes.begin(), draft.notes.end(),
                     [&](const std::string& note) { return note.find(words) != std::string::npos; });
}

TEST(DraftDrive, ReadsOffALogWhichColumnsAreTheUnitsAndWhichTheFirstReceivers) {
  const auto draft = draft_drive({flight_log(), std::nullopt, drive::Vehicle::Road});
  ASSERT_TRUE(draft) << draft.error().message;
  EXPECT_EQ(draft->id, "flight");
  EXPECT_EQ(draft->unit.columns.size(), 6U);
  EXPECT_EQ(told(draft->unit, drive::Quantity::AngularRate, "z"), "gyro_z (rad/s) in rad/s");
  EXPECT_EQ(draft->unit.time_column, "time (s)");
  EXPECT_EQ(draft->receiver.file, "flight.ulg");
  EXPECT_EQ(draft->receiver.time_column, "gnss_time (s)");
  EXPECT_EQ(draft->receiver.scale, drive::TimeScale::Boot);
  EXPECT_EQ(told(draft->receiver, drive::Quantity::GnssPosition, "height"), "gnss_height (m) in m");
  EXPECT_FALSE(draft->geoid) << "the height above the ellipsoid is there";
  EXPECT_EQ(told(draft->receiver, drive::Quantity::GnssVelocity, "down"), "gnss_velocity_down (m/s) in m/s");
  EXPECT_EQ(told(draft->receiver, drive::Quantity::FixType, ""), "gnss_fix_type in ");
  EXPECT_TRUE(notes_say(*draft, "gnss2 is another receiver's"));
  EXPECT_TRUE(draft->mounting_unknown);
}

TEST(DraftDrive, OfAVehicleThatDoesNotMoveAlongItsNoseTakesTheAxesAsTheyAreAndSaysSo) {
  const auto draft = draft_drive({flight_log(), std::nullopt, drive::Vehicle::Air});
  ASSERT_TRUE(draft);
  EXPECT_FALSE(draft->mounting_unknown);
  EXPECT_TRUE(notes_say(*draft, "mounting_deg"));
}

TEST(DraftDrive, TakesFixesOfAFileOfTheirOwnOnTheClockOfItsFormat) {
  DraftFile unit = flight_log();
  unit.names.resize(7);
  const DraftFile receiver{
      "rover.pos",
      "rtklib_pos",
      {"time (s)", "latitude(deg)", "longitude(deg)", "height(m)", "Q", "ns", "vn(m/s)", "ve(m/s)", "vu(m/s)", "speed"},
      {}};
  const auto draft = draft_drive({unit, receiver, drive::Vehicle::Road});
  ASSERT_TRUE(draft) << draft.error().message;
  EXPECT_EQ(draft->receiver.scale, drive::TimeScale::Gps);
  EXPECT_EQ(told(draft->receiver, drive::Quantity::GnssVelocity, "up"), "vu(m/s) in m/s");
  EXPECT_EQ(told(draft->receiver, drive::Quantity::GnssSpeed, ""), "none") << "velocities say it already";
  EXPECT_TRUE(notes_say(*draft, "clock"));
}

TEST(DraftDrive, TakesFixesThatStandInTheRowsOfTheUnit) {
  const DraftFile timed{"car.csv",
                        "csv",
                        {"time [ms]", "ax [m/s^2]", "ay [m/s^2]", "az [m/s^2]", "gx [deg/s]", "gy [deg/s]",
                         "gz [deg/s]", "speed [km/h]", "course", "latitude", "longitude", "altitude"},
                        {}};
  const auto draft = draft_drive({timed, std::nullopt, drive::Vehicle::Road});
  ASSERT_TRUE(draft) << draft.error().message;
  EXPECT_EQ(draft->receiver.file, "car.csv");
  EXPECT_EQ(draft->receiver.time_column, "time [ms]");
  EXPECT_EQ(draft->receiver.time_unit, "ms");
  EXPECT_EQ(told(draft->receiver, drive::Quantity::GnssPosition, "lat"), "latitude in deg");
  EXPECT_EQ(told(draft->receiver, drive::Quantity::GnssSpeed, ""), "speed [km/h] in km/h");
  EXPECT_TRUE(notes_say(*draft, "rows that repeat a fix are no new data"));
}

TEST(DraftDrive, OfHeightsAboveTheGeoidOnlySaysSo) {
  DraftFile log = flight_log();
  std::erase(log.names, "gnss_height (m)");
  const auto draft = draft_drive({log, std::nullopt, drive::Vehicle::Road});
  ASSERT_TRUE(draft);
  EXPECT_TRUE(draft->geoid);
  EXPECT_EQ(told(draft->receiver, drive::Quantity::GnssPosition, "height"), "gnss_altitude (m) in m");
}

TEST(DraftDrive, WhatNoColumnSaysIsRefusedByItsName) {
  const auto error_without = [](const std::string& name) {
    DraftFile log = flight_log();
    std::erase(log.names, name);
    const auto draft = draft_drive({log, std::nullopt, drive::Vehicle::Road});
    return draft ? std::string("accepted") : draft.error().message;
  };
  EXPECT_NE(error_without("gyro_y (rad/s)").find("the angular rate along y"), std::string::npos);
  EXPECT_NE(error_without("acc_x (m/s^2)").find("the specific force along x"), std::string::npos);
  EXPECT_NE(error_without("gnss_latitude (deg)").find("the latitude of the fixes"), std::string::npos);
  EXPECT_NE(error_without("gnss_time (s)").find("the time of the fixes"), std::string::npos);
  EXPECT_NE(error_without("time (s)").find("state the rate of its rows"), std::string::npos);
  DraftFile log = flight_log();
  std::erase(log.names, "time (s)");
  log.spec.rate_hz = 200.0;
  const auto draft = draft_drive({log, std::nullopt, drive::Vehicle::Road});
  ASSERT_TRUE(draft);
  EXPECT_EQ(draft->unit.scale, drive::TimeScale::Row);
  EXPECT_EQ(draft->unit.rate_hz, 200.0);
}

}  // namespace
}  // namespace driftlab
