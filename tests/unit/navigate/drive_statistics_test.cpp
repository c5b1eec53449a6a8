// Intervals of outages that share their errors, folds that know nothing of each other, and constants as states.
#include "core/navigate/drive/profile.hpp"
#include "tests/unit/navigate/drive_injections.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

namespace driftlab::drive {
namespace {

DriveOutage outage_from(double start_s, double error_m = 1.0) {
  DriveOutage outage;
  outage.outage = {start_s, 10.0};
  outage.error_ned_m = Vector3(error_m, 0.0, 0.0);
  return outage;
}

TEST(DriveStatistics, ABlockHoldsTheOutagesOfOnePeriodOfAllPhases) {
  std::vector<DriveOutage> outages;
  for (const double start : {60.0, 100.0, 140.0, 65.0, 105.0, 139.9, 300.0}) {
    outages.push_back(outage_from(start));
  }
  const auto blocks = blocks_of(outages, 40.0);
  ASSERT_EQ(blocks.size(), 4U) << "periods without an outage are no blocks";
  EXPECT_EQ(blocks[0], (std::vector<std::size_t>{0, 3}));
  EXPECT_EQ(blocks[1], (std::vector<std::size_t>{1, 4, 5}));
  EXPECT_EQ(blocks[2], (std::vector<std::size_t>{2}));
  EXPECT_EQ(blocks[3], (std::vector<std::size_t>{6}));
}

TEST(DriveStatistics, PhasesOfOneOutageAreNoIndependentEvidence) {
  // Eight phases of 40 periods whose outages share one error each: the mean is as uncertain as that of 40
  // numbers, 1.96/ sqrt(40) = 0.31, where 320 would give 0.11. An interval holds the truth in 95 % of 200 such drives.
  constexpr std::size_t kPeriods = 40;
  constexpr std::size_t kPhases = 8;
  Random random(9, 1);
  double width = 0.0;
  int holds = 0;
  for (int drive = 0; drive < 200; ++drive) {
    std::vector<double> shared(kPeriods);
    std::generate(shared.begin(), shared.end(), [&] { return random.normal(); });
    std::vector<DriveOutage> outages;
    for (std::size_t phase = 0; phase < kPhases; ++phase) {
      for (std::size_t period = 0; period < kPeriods; ++period) {
        outages.push_back(outage_from(40.0 * static_cast<double>(period) + 5.0 * static_cast<double>(phase)));
      }
    }
    const auto mean = [&](std::span<const std::size_t> which) {
      double sum = 0.0;
      for (const std::size_t i : which) {
        sum += shared[i % kPeriods];
      }
      return sum / static_cast<double>(which.size());
    };
    const EvaluationOptions settings{.seed = static_cast<std::uint64_t>(drive), .resamples = 300};
    const Interval interval = bootstrap_interval(blocks_of(outages, 40.0), mean, settings, 1);
    width += 0.5 * (interval.high - interval.low) / 200.0;
    holds += interval.contains(0.0) ? 1 : 0;
  }
  EXPECT_NEAR(width, 0.31, 0.03);
  EXPECT_GE(holds, 178);  // three standard deviations below 95 %, less 1 % for percentiles of 40
}

TEST(DriveStatistics, TheShareInsideAnEllipseIsThatOfItsErrors) {
  std::vector<DriveOutage> outages;
  for (int i = 0; i < 100; ++i) {
    outages.push_back(outage_from(10.0 * i, i % 4 == 0 ? 3.0 : 1.0));  // NEES 9 and 1, of variance 1
    outages.back().covariance_ned = Matrix3::Identity();
  }
  const auto blocks = blocks_of(outages, 10.0);
  const Estimate wide = share_inside(outages, blocks, 0.95, {}, 1);    // up to 5.99
  const Estimate narrow = share_inside(outages, blocks, 0.30, {}, 1);  // up to 0.71
  EXPECT_DOUBLE_EQ(wide.value, 0.75);
  EXPECT_DOUBLE_EQ(narrow.value, 0.0);
  EXPECT_NEAR(wide.ci95.high - wide.ci95.low, 2.0 * 1.96 * std::sqrt(0.75 * 0.25 / 100.0), 0.04);
}

TEST(DriveStatistics, AnOutageAcrossTheBorderOfTwoFoldsBelongsToNone) {
  EXPECT_EQ(fold_of({20.0, 30.0}), 0U);
  EXPECT_EQ(fold_of({120.0, 30.0}), 1U);
  EXPECT_EQ(fold_of({220.0, 30.0}), 0U);
  EXPECT_FALSE(fold_of({90.0, 30.0}));
  EXPECT_EQ(fold_at(99.9), 0U);
  EXPECT_EQ(fold_at(100.0), 1U);
}

TEST(DriveStatistics, WhatOneFoldShowsTheOtherDoesNotKnow) {
  // Fixes of the last stretch, fold 1, are spoilt: fold 0 has the same likelihood and the same estimate, to the bit.
  Hidden hidden;
  hidden.imu_offset_s = 0.05;
  const Drive drive = simulated_drive(51, hidden, 3);
  Drive spoilt = drive;
  for (Fix& fix : spoilt.fixes) {
    if (fix.time_s > 302.0) {
      fix.position_ecef_m += Vector3(3.0, 0.0, 0.0);
    }
  }
  const auto whole = log_likelihood(drive, {});
  const auto other = log_likelihood(spoilt, {});
  ASSERT_TRUE(whole && other);
  EXPECT_EQ(whole->sum[0], other->sum[0]);
  EXPECT_GT(whole->sum[1], other->sum[1]);
  const Knob* const clock = find_knob("imu_time_offset", "delta_s");
  const RunControl control;
  const FilterOptions sound = Profile(drive, {true, false}, control).refitted({}, {clock}, 2);
  const FilterOptions blind = Profile(spoilt, {true, false}, control).refitted({}, {clock}, 2);
  EXPECT_EQ(sound.imu_offset_s, blind.imu_offset_s);
  EXPECT_NEAR(sound.imu_offset_s, 0.05, 0.01);
}

TEST(DriveStatistics, GainsAreThoseOfOutagesThatFoundNothing) {
  Hidden hidden;
  hidden.imu_offset_s = 0.1;
  Drive drive = simulated_drive(52, hidden, 3);
  drive.document.outages.duration_s = {10.0};
  drive.document.outages.every_s = {40.0};
  const auto explained = explain_drive(drive, drive, {.simulated_runs = 1, .most_causes = 1});
  ASSERT_TRUE(explained) << explained.error().message;
  std::size_t whole = 0;  // outages that lie in one stretch: each is seen once and unseen once
  for (const DriveOutage& one : explained->before.durations.front().outages) {
    whole += fold_of(one.outage) ? 1 : 0;
  }
  for (const Rung& rung : explained->rungs) {
    EXPECT_EQ(rung.durations.front().found_count, whole) << rung.name;
    EXPECT_EQ(rung.durations.front().held_out_count, whole) << rung.name;
  }
  const auto clock = std::find_if(explained->findings.begin(), explained->findings.end(),
                                  [](const DriveFinding& finding) { return finding.cause == "imu_time_offset"; });
  ASSERT_NE(clock, explained->findings.end());
  EXPECT_TRUE(clock->judged && clock->kept);
  EXPECT_GT(clock->held_out_gain, 0.0);
  const RungFigures& first = explained->rungs.front().durations.front();
  const RungFigures& last = explained->rungs.back().durations.front();
  EXPECT_LT(last.held_out_rms_m, 0.7 * first.held_out_rms_m);
  EXPECT_GT(last.held_out_log_score, first.held_out_log_score);
}

/// Mean errors and NEES of the outages of 60 s.
std::array<double, 2> of_long_outages(const Drive& drive, const FilterOptions& options) {
  const auto evaluation = evaluate_drive(drive, options);
  EXPECT_TRUE(evaluation);
  const DurationSummary& longest = evaluation->durations.back();
  return {longest.rms_m.value, longest.nees.value};
}

TEST(DriveStatistics, TheScaleOfTheOdometerIsEstimatedAsAState) {
  const Drive drive = with_odometer(53, 0.03, 0.0, 4);
  FilterOptions believed;
  believed.odometer = true;
  FilterOptions estimated = believed;
  estimated.constants = declared_states(drive.document, estimated);
  const auto [wrong_rms, wrong_nees] = of_long_outages(drive, believed);
  const auto [rms, nees] = of_long_outages(drive, estimated);
  EXPECT_LT(rms, 0.7 * wrong_rms);
  EXPECT_LT(nees, 4.0);
  EXPECT_GT(wrong_nees, 2.0 * nees);
}

TEST(DriveStatistics, TheMountingIsEstimatedAsAState) {
  Drive drive = simulated_drive(54, {}, 4);
  turn_readings(drive, Eigen::AngleAxisd(2.0 * kDegree, Vector3::UnitZ()).toRotationMatrix());
  FilterOptions believed;
  believed.constraint.emplace();
  FilterOptions estimated = believed;
  drive.document.imu.mounting_sd_rad = 3.0 * kDegree;
  estimated.constants = declared_states(drive.document, estimated);
  const auto [wrong_rms, wrong_nees] = of_long_outages(drive, believed);
  const auto [rms, nees] = of_long_outages(drive, estimated);
  EXPECT_LT(rms, 0.7 * wrong_rms);
  EXPECT_LT(nees, 4.0);
  EXPECT_GT(wrong_nees, 2.0 * nees);
}

}  // namespace
}  // namespace driftlab::drive
