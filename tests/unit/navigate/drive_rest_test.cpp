// What a filter makes of a vehicle at rest: velocity 0, and no turn of one on wheels; and which fixes a gate believes.
#include "core/navigate/drive/evaluation.hpp"
#include "core/navigate/drive/fix_gate.hpp"
#include "tests/unit/navigate/drive_fixture.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace driftlab::drive {
namespace {

/// The town's car stands from 111 s on until it starts again at 120 s, and so on every 100 s.
const std::vector<Outage> kAtRest{{112.0, 7.5}, {212.0, 7.5}, {312.0, 7.5}};

FilterRun run_of(const Drive& drive, const FilterOptions& options, const std::vector<Outage>& outages) {
  const auto prepared = PreparedDrive::make(drive, options);
  EXPECT_TRUE(prepared);
  FilterTask task;
  task.outages = outages;
  task.keep_innovations = true;
  return prepared->run(0, task);
}

std::size_t count_of(const FilterRun& run, MeasurementKind kind) {
  return static_cast<std::size_t>(std::count_if(run.innovations.begin(), run.innovations.end(),
                                                [&](const Innovation& one) { return one.kind == kind; }));
}

TEST(DriveRest, ZeroVelocityHoldsAnOutageAtRest) {
  FilterOptions still;
  still.zero_velocity = true;
  double squared_with = 0.0;
  double squared_without = 0.0;
  for (const std::uint64_t seed : {61U, 62U, 63U}) {
    const Drive drive = simulated_drive(seed);
    const FilterRun with = run_of(drive, still, kAtRest);
    const FilterRun without = run_of(drive, {}, kAtRest);
    ASSERT_EQ(with.outages.size(), kAtRest.size());
    EXPECT_EQ(count_of(without, MeasurementKind::ZeroVelocity), 0U);
    EXPECT_GE(count_of(with, MeasurementKind::ZeroVelocity), 20U) << "seven a stop";
    for (std::size_t i = 0; i < kAtRest.size(); ++i) {
      squared_with += with.outages[i].error_ned_m.head<2>().squaredNorm();
      squared_without += without.outages[i].error_ned_m.head<2>().squaredNorm();
      // 5 cm/s of a start with fixes grow to 38 cm in 7.5 s; held to 2 cm/s every second they stay below 5 cm.
      EXPECT_LT(with.outages[i].covariance_ned(0, 0), 0.7 * without.outages[i].covariance_ned(0, 0));
    }
  }
  EXPECT_LT(squared_with, squared_without);
}

/// A gyroscope whose bias walks by 0.03 deg/s in a second: what it reads at rest is news.
Drive with_a_walking_bias(std::uint64_t seed, Vehicle vehicle) {
  Drive drive = simulated_drive(seed);
  drive.document.vehicle = vehicle;
  AxisModel& down = drive.document.model.axes[2];
  down.processes = ModelSchedule::constant(
      {*make_process("white_noise", {0.02 * kDegree}), *make_process("random_walk", {0.03 * kDegree})});
  return drive;
}

TEST(DriveRest, AVehicleOnWheelsDoesNotTurn) {
  FilterOptions still;
  still.zero_velocity = true;
  const FilterRun road = run_of(with_a_walking_bias(64, Vehicle::Road), still, kAtRest);
  const FilterRun air = run_of(with_a_walking_bias(64, Vehicle::Air), still, kAtRest);
  EXPECT_EQ(count_of(air, MeasurementKind::ZeroTurn), 0U) << "the wind may turn an aircraft at rest";
  EXPECT_EQ(count_of(road, MeasurementKind::ZeroTurn), count_of(road, MeasurementKind::ZeroVelocity));
  ASSERT_EQ(road.outages.size(), air.outages.size());
  for (std::size_t i = 0; i < road.outages.size(); ++i) {
    EXPECT_LT(road.outages[i].heading_sd_rad, 0.8 * air.outages[i].heading_sd_rad) << i;
  }
  // It really does not turn: innovations are no larger than the filter expects.
  for (const Innovation& one : road.innovations) {
    if (one.kind == MeasurementKind::ZeroTurn) {
      EXPECT_LT(one.scalar[0].value * one.scalar[0].value / one.scalar[0].variance, 16.0) << one.time_s;
    }
  }
}

TEST(FixGate, BelievesAgainAfterFiveAndForgetsWhatIsLongAgo) {
  FixGate gate(9.0, 60);
  for (int i = 0; i < FixGate::kRejectedInARow; ++i) {
    EXPECT_FALSE(gate.accepts(100.0));
  }
  for (int i = 0; i < 500; ++i) {
    EXPECT_TRUE(gate.accepts(100.0)) << "the receiver is right and the filter is not";
  }
  int believed = 0;
  while (believed < 1000) {  // agreeing fixes until a wild one is rejected again
    FixGate copy = gate;
    if (!copy.accepts(100.0)) {
      break;
    }
    EXPECT_TRUE(gate.accepts(1.0));
    ++believed;
  }
  EXPECT_EQ(believed, 60 - FixGate::kRejectedInARow + 1) << "not the five hundred that disagreed";
}

}  // namespace
}  // namespace driftlab::drive
