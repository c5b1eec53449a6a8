// Outages of a recorded drive: where they lie, how errors grow in them, and which count.
#include "core/navigate/drive/evaluation.hpp"
#include "tests/unit/navigate/drive_fixture.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace driftlab::drive {
namespace {

TEST(DriveOutages, NeverOverlapAndLeaveTwentySecondsOfFixes) {
  const Drive drive = simulated_drive(15);
  const auto start = find_start(drive, 0);
  ASSERT_TRUE(start);
  const auto runs = plan_outages(drive, *start);
  EXPECT_GT(runs.size(), 16U);
  for (const PlannedRun& run : runs) {
    for (std::size_t i = 1; i < run.outages.size(); ++i) {
      EXPECT_GE(run.outages[i].start_s, run.outages[i - 1].end_s() + 20.0);
    }
    EXPECT_GE(run.outages.front().start_s, start->time_s + 60.0);
  }
}

TEST(DriveOutages, TheErrorIsFollowedFromTheLossOfTheFixesToTheirReturn) {
  // Its end alone does not say whether an outage is ruled by an error of velocity or of the gyroscope.
  const Drive drive = simulated_drive(23);
  const auto evaluation = evaluate_drive(drive, {});
  ASSERT_TRUE(evaluation);
  for (const DurationSummary& one : evaluation->durations) {
    const ErrorGrowth& growth = one.growth;
    ASSERT_EQ(growth.time_s.size(), kGrowthPoints);
    EXPECT_DOUBLE_EQ(growth.time_s.front(), one.duration_s / static_cast<double>(kGrowthPoints));
    EXPECT_DOUBLE_EQ(growth.time_s.back(), one.duration_s);
    EXPECT_EQ(growth.count.back(), one.outages.size());
    EXPECT_DOUBLE_EQ(growth.rms_m.back(), one.rms_m.value);
    EXPECT_DOUBLE_EQ(growth.median_m.back(), one.median_m.value);
    EXPECT_DOUBLE_EQ(growth.p95_m.back(), one.p95_m);
    for (std::size_t k = 0; k < kGrowthPoints; ++k) {
      EXPECT_LE(growth.p05_m[k], growth.median_m[k]);
      EXPECT_LE(growth.median_m[k], growth.p95_m[k]);
    }
    EXPECT_LT(growth.rms_m[kGrowthPoints / 2 - 1], 0.6 * growth.rms_m.back()) << "faster than the time";
    for (const DriveOutage& outage : one.outages) {
      EXPECT_EQ(outage.growth_m.size(), kGrowthPoints);
    }
  }
}

TEST(DriveOutages, AGapOfTheReferenceIsNoErrorOfZero) {
  Drive drive = simulated_drive(24);
  const auto before = evaluate_drive(drive, {});
  ASSERT_TRUE(before);
  const DriveOutage& first = before->durations.back().outages.front();
  const double middle = first.outage.start_s + 0.5 * first.outage.duration_s;
  std::erase_if(drive.reference, [&](const ReferencePoint& point) { return std::abs(point.time_s - middle) < 4.0; });
  const auto after = evaluate_drive(drive, {});
  ASSERT_TRUE(after);
  const DriveOutage& gappy = after->durations.back().outages.front();
  ASSERT_EQ(gappy.growth_m.size(), kGrowthPoints);
  EXPECT_TRUE(std::isnan(gappy.growth_m[kGrowthPoints / 2 - 1]));
  EXPECT_EQ(gappy.growth_m.front(), first.growth_m.front());
  EXPECT_LT(after->durations.back().growth.count[kGrowthPoints / 2 - 1], after->durations.back().growth.count.back());
}

TEST(DriveOutages, ThoseOfTheReceiverItselfAreListedAndNotScored) {
  Drive drive = simulated_drive(28);
  const auto whole = evaluate_drive(drive, {});
  ASSERT_TRUE(whole);
  EXPECT_TRUE(whole->natural.empty());
  const auto lost = [](double time_s) { return time_s > 200.1 && time_s < 207.2; };
  std::erase_if(drive.fixes, [&](const Fix& fix) { return lost(fix.time_s); });
  std::erase_if(drive.reference, [&](const ReferencePoint& point) { return lost(point.time_s); });
  const auto evaluation = evaluate_drive(drive, {});
  ASSERT_TRUE(evaluation);
  ASSERT_EQ(evaluation->natural.size(), 1U);
  EXPECT_NEAR(evaluation->natural.front().start_s, 200.0037, 1e-9);
  EXPECT_NEAR(evaluation->natural.front().duration_s, 7.25, 1e-9);
  const auto ends_in_it = [](const DriveOutage& one) {
    return std::min(std::abs(one.outage.start_s - 203.6), std::abs(one.outage.end_s() - 203.6)) < 2.0;
  };
  for (const DurationSummary& one : evaluation->durations) {
    EXPECT_EQ(std::count_if(one.outages.begin(), one.outages.end(), ends_in_it), 0) << "no reference lies at its end";
  }
}

TEST(DriveOutages, StatedStartsThatAreNotScoredAreNamed) {
  Drive drive = simulated_drive(29);
  drive.document.outages.duration_s = {10.0};
  drive.document.outages.at_s = {5.0, 100.0, 115.0, 200.0};
  const auto evaluation = evaluate_drive(drive, {});
  ASSERT_TRUE(evaluation);
  EXPECT_EQ(evaluation->durations.front().outages.size(), 2U);
  ASSERT_FALSE(evaluation->notes.empty());
  EXPECT_NE(evaluation->notes.front().find("outages of 10 s from 5 s, 10 s from 115 s."), std::string::npos)
      << evaluation->notes.front();
}

TEST(DriveOutages, ClassesAreByTheMotionWithoutFixes) {
  Drive drive = simulated_drive(30);
  drive.document.outages.duration_s = {4.0};
  drive.document.outages.at_s = {132.5, 213.0, 241.0};  // a turn of 12 deg/s; standing; straight on
  const auto evaluation = evaluate_drive(drive, {});
  ASSERT_TRUE(evaluation);
  const DurationSummary& summary = evaluation->durations.front();
  ASSERT_EQ(summary.outages.size(), 3U);
  EXPECT_EQ(summary.outages[0].outage_class, OutageClass::Turning);
  EXPECT_EQ(summary.outages[1].outage_class, OutageClass::Rest);
  EXPECT_EQ(summary.outages[2].outage_class, OutageClass::Straight);
  ASSERT_EQ(summary.classes.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(summary.classes[i].count, 1U);
  }
}

TEST(DriveOutages, TheSameForAnyNumberOfThreads) {
  const Drive drive = simulated_drive(16);
  Executor executor(2);
  RunControl control;
  control.threads.executor = &executor;
  const auto one = evaluate_drive(drive, {});
  const auto two = evaluate_drive(drive, {}, {}, control);
  ASSERT_TRUE(one && two);
  for (std::size_t d = 0; d < one->durations.size(); ++d) {
    EXPECT_EQ(one->durations[d].rms_m.value, two->durations[d].rms_m.value);
    EXPECT_EQ(one->durations[d].nees.ci95.high, two->durations[d].nees.ci95.high);
  }
}

}  // namespace
}  // namespace driftlab::drive
