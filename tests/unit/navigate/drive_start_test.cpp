// Where a recorded drive begins: tilt, heading, what is stated, and what cannot be observed.
#include "core/navigate/drive/evaluation.hpp"
#include "tests/unit/navigate/drive_fixture.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace driftlab::drive {
namespace {

TEST(DriveStart, FindsRestTiltAndCourse) {
  const Drive drive = simulated_drive(17);
  const auto rests = rests_of(drive, 0);
  ASSERT_FALSE(rests.empty());
  EXPECT_NEAR(rests.front().to_s, 20.0, 1.0);
  const auto start = find_start(drive, 0);
  ASSERT_TRUE(start);
  EXPECT_EQ(start->tilt_from, TiltFrom::Rest);
  EXPECT_EQ(start->heading_from, HeadingFrom::Course);
  EXPECT_NEAR(start->time_s, 21.6, 0.6);
}

/// A drive whose readings begin where it gains speed by 2 m/s^2, so that no rest shows the tilt.
Drive begun_in_motion(std::uint64_t seed) {
  Drive drive = simulated_drive(seed);
  UniformRun& run = drive.runs.front();
  const auto first = static_cast<std::ptrdiff_t>(std::lround(21.0 / run.dt_s));
  run.readings.erase(run.readings.begin(), run.readings.begin() + first);
  run.start_s += static_cast<double>(first) * run.dt_s;
  return drive;
}

TEST(DriveStart, ChangesOfSpeedAreNoTilt) {
  // Over one second of 2 m/s^2 the mean force leans by 12 deg, stated as 3.
  const Drive drive = begun_in_motion(25);
  const auto start = find_start(drive, 0);
  ASSERT_TRUE(start) << start.error().message;
  EXPECT_EQ(start->tilt_from, TiltFrom::Motion);
  EXPECT_NEAR(start->attitude().pitch_rad, 0.0, 2.0 * kDegree);
  EXPECT_NEAR(start->attitude().roll_rad, 0.0, 2.0 * kDegree);
  EXPECT_NEAR(start->uncertainty.tilt_sd_rad, std::hypot(3.0, 5.8) * kDegree, 1.5 * kDegree) << "half of 12 deg";
  Drive silent = drive;
  for (Fix& fix : silent.fixes) {
    fix.has_course = false;
    fix.velocity_ned_m_s.reset();
  }
  silent.document.start.heading_rad = 0.0;
  const auto leaning = find_start(silent, 0);
  ASSERT_TRUE(leaning);
  EXPECT_GT(std::abs(leaning->attitude().pitch_rad), 8.0 * kDegree) << "else the test shows nothing";
}

TEST(DriveStart, WhatTheDocumentStatesIsTrueOfTheBeginningAlone) {
  // A stated place was taken for that of the first fast fix, a minute later, and of every run behind a gap.
  Drive drive = simulated_drive(26);
  const Geodetic elsewhere{48.1 * kDegree, 9.0 * kDegree, 300.0};
  drive.document.start.position = elsewhere;
  const auto late = find_start(drive, 0);
  ASSERT_TRUE(late);
  EXPECT_GT((late->state.position_ecef_m - to_ecef(elsewhere)).norm(), 5000.0) << "it starts after 21 s";
  drive.document.start.heading_rad = 0.3;
  drive.document.start.velocity_ned_m_s = Vector3(0.5, 0.0, 0.0);
  const auto first = find_start(drive, 0);
  ASSERT_TRUE(first);
  EXPECT_LT(first->time_s, 2.0);
  EXPECT_LT((first->state.position_ecef_m - to_ecef(elsewhere)).norm(), 2.0);
  EXPECT_NEAR(first->attitude().heading_rad, 0.3, 1e-9);
  UniformRun& whole = drive.runs.front();
  const auto half = static_cast<std::ptrdiff_t>(whole.readings.size() / 2);
  UniformRun behind{whole.start_s + static_cast<double>(half + 200) * whole.dt_s,
                    whole.dt_s,
                    {whole.readings.begin() + half + 200, whole.readings.end()}};
  whole.readings.resize(static_cast<std::size_t>(half));
  drive.runs.push_back(std::move(behind));
  const auto second = find_start(drive, 1);
  ASSERT_TRUE(second) << second.error().message;
  EXPECT_EQ(second->heading_from, HeadingFrom::Course);
  EXPECT_GT((second->state.position_ecef_m - to_ecef(elsewhere)).norm(), 5000.0);
  EXPECT_GT(second->state.velocity_ecef_m_s.norm(), 3.0);
  const auto evaluation = evaluate_drive(drive, {});
  ASSERT_TRUE(evaluation);
  EXPECT_EQ(evaluation->starts.size(), 2U);
}

TEST(DriveStart, ARunThatCannotBeginIsNamedWithTheReason) {
  Drive drive = simulated_drive(27);
  UniformRun& whole = drive.runs.front();
  const auto kept = static_cast<std::ptrdiff_t>(std::lround(300.0 / whole.dt_s));
  UniformRun behind{whole.start_s + 410.0, whole.dt_s, {}};
  behind.readings.assign(whole.readings.begin() + std::lround(410.0 / whole.dt_s), whole.readings.end());
  whole.readings.resize(static_cast<std::size_t>(kept));
  drive.runs.push_back(std::move(behind));  // the last ten seconds, at rest
  const auto evaluation = evaluate_drive(drive, {});
  ASSERT_TRUE(evaluation) << evaluation.error().message;
  ASSERT_FALSE(evaluation->notes.empty());
  EXPECT_NE(evaluation->notes.back().find("The filter cannot begin in the readings from 410 to 420 s: No fix moves"),
            std::string::npos)
      << evaluation->notes.back();
}

TEST(DriveStart, SaysThatADriveAtRestHasNoHeading) {
  Drive drive = simulated_drive(18);
  for (Fix& fix : drive.fixes) {
    fix.velocity_ned_m_s = Vector3::Zero();
    fix.has_course = false;
  }
  const auto start = find_start(drive, 0);
  ASSERT_FALSE(start);
  EXPECT_NE(start.error().message.find("heading is not observable"), std::string::npos);
}

}  // namespace
}  // namespace driftlab::drive
