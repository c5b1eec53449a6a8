// Simulated outages beside measured ones: the simulation covers itself, and their ratio has its scatter.
#include "core/navigate/drive/evaluation.hpp"
#include "core/navigate/drive/simulation.hpp"
#include "tests/unit/navigate/drive_fixture.hpp"

#include <gtest/gtest.h>

namespace driftlab::drive {
namespace {

TEST(DriveSimulation, CoversItselfWithAndWithoutAVelocityConstraint) {
  // The simulated truth has the side slip of the recorded attitude; the constraint must not count it as an error.
  const Drive drive = simulated_drive(19);
  for (const bool constrained : {false, true}) {
    FilterOptions options;
    if (constrained) {
      options.constraint.emplace();
    }
    const auto evaluation = evaluate_drive(drive, options);
    ASSERT_TRUE(evaluation);
    const auto prepared = PreparedDrive::make(drive, options);
    const auto simulated = simulate_outages(*prepared, evaluation->durations, {.runs = 8, .seed = 2});
    ASSERT_TRUE(simulated) << simulated.error().message;
    for (const SimulatedDuration& one : *simulated) {
      EXPECT_GT(one.coverage95.value, 0.91) << one.duration_s << (constrained ? " constrained" : "");
      EXPECT_NEAR(one.nees.value, 2.0, 0.5) << one.duration_s << (constrained ? " constrained" : "");
      EXPECT_TRUE(one.nees.ci95.contains(one.nees.value));
      EXPECT_TRUE(one.coverage95.ci95.contains(one.coverage95.value));
      EXPECT_TRUE(one.coverage95.ci95.contains(0.95)) << one.coverage95.ci95.low << " to " << one.coverage95.ci95.high;
    }
  }
}

TEST(DriveSimulation, HasTheOdometerThatWasMeasuredWith) {
  // Without readings of the wheel the simulated outages were those of fixes and unit alone, and measured ones with it
  // looked better than their simulation.
  Drive drive = simulated_drive(21);
  OdometerSource& source = drive.document.odometer.emplace();
  source.sd_m_s = 0.05;
  Random random(21, 8);
  for (const Fix& fix : drive.fixes) {
    drive.odometer.push_back({fix.time_s, 1.02 * fix.velocity_ned_m_s->head<2>().norm() + 0.05 * random.normal()});
  }
  FilterOptions with;
  with.odometer = true;
  with.odometer_scale = 0.02;
  FilterOptions without;
  std::array<double, 2> rms{};
  for (const bool wheel : {false, true}) {
    const auto evaluation = evaluate_drive(drive, wheel ? with : without);
    const auto prepared = PreparedDrive::make(drive, wheel ? with : without);
    ASSERT_TRUE(evaluation && prepared);
    const auto simulated = simulate_outages(*prepared, evaluation->durations, {.runs = 8, .seed = 2});
    ASSERT_TRUE(simulated);
    const SimulatedDuration& longest = simulated->back();
    rms[wheel ? 1 : 0] = longest.rms_m;
    EXPECT_NEAR(longest.nees.value, 2.0, 0.6) << wheel;
    EXPECT_GT(longest.coverage95.value, 0.9) << wheel;
    EXPECT_GT(longest.ratio.value, 0.75) << wheel;  // one measured drive has some ten such outages
    EXPECT_LT(longest.ratio.value, 1.5) << wheel;
  }
  EXPECT_LT(rms[1], 0.7 * rms[0]) << "the speed along the way is known";
}

TEST(DriveSimulation, TheRatiosIntervalHoldsTheScatterOfTheSimulationToo) {
  // Fewer simulated drives say less of the simulated rms: the interval of the ratio widens, where that of the measured
  // rms alone, divided by the simulated one, would stay.
  const Drive drive = simulated_drive(20);
  const auto evaluation = evaluate_drive(drive, {});
  const auto prepared = PreparedDrive::make(drive, {});
  ASSERT_TRUE(evaluation && prepared);
  const auto few = simulate_outages(*prepared, evaluation->durations, {.runs = 1, .seed = 3});
  const auto many = simulate_outages(*prepared, evaluation->durations, {.runs = 12, .seed = 3});
  ASSERT_TRUE(few && many);
  const auto width = [](const SimulatedDuration& one) {
    return (one.ratio.ci95.high - one.ratio.ci95.low) / one.ratio.value;
  };
  const Estimate& rms = evaluation->durations.front().rms_m;
  EXPECT_GT(width(few->front()), 1.1 * (rms.ci95.high - rms.ci95.low) / rms.value);
  EXPECT_GT(width(few->front()), width(many->front()));
}

}  // namespace
}  // namespace driftlab::drive
