// The filter of a recorded drive: withheld fixes leave no trace, it knows itself, and it gates.
#include "core/navigate/drive/evaluation.hpp"
#include "tests/unit/navigate/drive_fixture.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace driftlab::drive {
namespace {

/// The drive without the fixes that lie in an outage.
Drive without_fixes_in(const Drive& drive, const std::vector<Outage>& outages) {
  Drive fewer = drive;
  std::erase_if(fewer.fixes, [&](const Fix& fix) {
    return std::any_of(outages.begin(), outages.end(), [&](const Outage& o) { return o.covers(fix.time_s); });
  });
  return fewer;
}

TEST(DriveFilter, AFixInsideAnOutageLeavesNoTrace) {
  const Drive drive = simulated_drive(11, {.velocity_latency_s = 0.12});
  FilterOptions options;
  options.velocity_latency_s = 0.12;  // the first returning fix describes a velocity of the outage
  options.constraint.emplace();
  options.gate = 25.0;
  const auto prepared = PreparedDrive::make(drive, options);
  ASSERT_TRUE(prepared) << prepared.error().message;
  FilterTask task;
  task.outages = {{100.0, 10.0}, {160.0, 30.0}};
  const FilterRun all = prepared->run(0, task);
  const Drive fewer = without_fixes_in(drive, task.outages);
  const auto prepared_fewer = PreparedDrive::make(fewer, options);
  ASSERT_TRUE(prepared_fewer);
  const FilterRun some = prepared_fewer->run(0, task);
  ASSERT_EQ(all.outages.size(), 2U);
  ASSERT_EQ(some.outages.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(all.outages[i].error_ned_m, some.outages[i].error_ned_m);
    EXPECT_EQ(all.outages[i].covariance_ned, some.outages[i].covariance_ned);
  }
}

TEST(DriveFilter, KnowsItselfOnADriveOfItsOwnModel) {
  // 64 outages of 10 s, eight phases: 2 for the mean NEES within 0.7 (neighbours share most of their noise).
  const Drive drive = simulated_drive(12, {}, 6);
  const auto evaluation = evaluate_drive(drive, options_of(drive.document));
  ASSERT_TRUE(evaluation) << evaluation.error().message;
  const DurationSummary& ten = evaluation->durations.front();
  EXPECT_GT(ten.outages.size(), 60U);
  EXPECT_NEAR(ten.nees.value, 2.0, 0.7);
  EXPECT_GT(ten.coverage95.value, 0.88);
  EXPECT_LT(ten.rms_m.value, ten.straight_line_rms_m);
  ASSERT_GE(evaluation->innovations.size(), 2U);
  EXPECT_NEAR(evaluation->innovations[0].normalised, 1.0, 0.15);
}

TEST(DriveFilter, EstimatesTheArmAndSaysHowWell) {
  const Drive drive = simulated_drive(13, {.lever_arm_m = {0.8, -0.4, 0.0}});
  FilterOptions options;
  Document document = drive.document;
  document.gnss.lever_arm_sd_m = 1.0;
  options.constants = declared_states(document, options);
  const auto prepared = PreparedDrive::make(drive, options);
  ASSERT_TRUE(prepared);
  FilterTask task;
  task.outages = {{300.0, 10.0}};
  const FilterRun with = prepared->run(0, task);
  const auto unaware = PreparedDrive::make(drive, FilterOptions{});
  ASSERT_TRUE(unaware);
  const FilterRun without = unaware->run(0, task);
  EXPECT_LT(with.outages.front().error_m(), without.outages.front().error_m());
}

TEST(DriveFilter, RejectsAWildFixAndBelievesTheReceiverAgainAfterFive) {
  Drive drive = simulated_drive(14);
  for (Fix& fix : drive.fixes) {
    if (fix.time_s > 120.0 && fix.time_s < 120.5) {
      fix.position_ecef_m += Vector3(0.0, 50.0, 0.0);
    }
  }
  FilterOptions options;
  options.gate = 50.0;
  const auto prepared = PreparedDrive::make(drive, options);
  ASSERT_TRUE(prepared);
  EXPECT_EQ(prepared->run(0, {}).rejected, 2U);
  for (Fix& fix : drive.fixes) {
    if (fix.time_s > 200.0) {
      fix.position_ecef_m += Vector3(0.0, 50.0, 0.0);  // the receiver moves for good
    }
  }
  const auto moved = PreparedDrive::make(drive, options);
  ASSERT_TRUE(moved);
  EXPECT_LT(moved->run(0, {}).rejected, 40U);
}

}  // namespace
}  // namespace driftlab::drive
