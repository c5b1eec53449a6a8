// The explanation of a drive and its simulated outages were compared for one number of threads alone: what hands tasks
// out there must give the same bits for any number, as the evaluation does (drive_outages_test.cpp).
#include "core/signal/executor.hpp"
#include "tests/unit/navigate/drive_fixture.hpp"

#include <gmock/gmock.h>

namespace driftlab::drive {
namespace {

using testing::ElementsAreArray;

constexpr int kLaps = 2;

/// Work that two threads share.
class TwoThreads {
 public:
  TwoThreads() { control_.threads.executor = &executor_; }
  [[nodiscard]] const RunControl& control() const { return control_; }

 private:
  Executor executor_{2};
  RunControl control_;
};

/// A drive whose clock and antenna the filter is not told, with short outages.
Drive mistaken_drive() {
  Drive drive = simulated_drive(31, {.imu_offset_s = 0.05, .lever_arm_m = {1.0, 0.5, 0.0}}, kLaps);
  drive.document.outages.duration_s = {10.0};
  drive.document.outages.every_s = {40.0};
  drive.document.outages.phases = 1;
  return drive;
}

void expect_same(const Estimate& one, const Estimate& two) {
  EXPECT_EQ(one.value, two.value);
  EXPECT_EQ(one.ci95.low, two.ci95.low);
  EXPECT_EQ(one.ci95.high, two.ci95.high);
}

void expect_same(const std::vector<SimulatedDuration>& one, const std::vector<SimulatedDuration>& two) {
  ASSERT_EQ(one.size(), two.size());
  ASSERT_FALSE(one.empty());
  for (std::size_t d = 0; d < one.size(); ++d) {
    EXPECT_GT(one[d].count, 0U);
    EXPECT_EQ(one[d].count, two[d].count);
    EXPECT_EQ(one[d].rms_m, two[d].rms_m);
    EXPECT_EQ(one[d].median_m, two[d].median_m);
    expect_same(one[d].nees, two[d].nees);
    expect_same(one[d].coverage95, two[d].coverage95);
    expect_same(one[d].ratio, two[d].ratio);
    EXPECT_THAT(one[d].growth.rms_m, ElementsAreArray(two[d].growth.rms_m));
  }
}

TEST(DriveSimulation, IsTheSameForAnyNumberOfThreads) {
  const Drive drive = mistaken_drive();
  const auto evaluation = evaluate_drive(drive, {});
  const auto prepared = PreparedDrive::make(drive, {});
  ASSERT_TRUE(evaluation) << evaluation.error().message;
  ASSERT_TRUE(prepared) << prepared.error().message;
  const SimulationOptions options{.runs = 4, .seed = 5};
  const auto one = simulate_outages(*prepared, evaluation->durations, options);
  const auto two = simulate_outages(*prepared, evaluation->durations, options, TwoThreads().control());
  ASSERT_TRUE(one && two);
  expect_same(*one, *two);
}

TEST(DriveExplanation, IsTheSameForAnyNumberOfThreads) {
  const Drive drive = mistaken_drive();
  ExplainOptions options;
  options.simulated_runs = 2;
  options.most_causes = 1;
  const auto one = explain_drive(drive, drive, options);
  const auto two = explain_drive(drive, drive, options, TwoThreads().control());
  ASSERT_TRUE(one && two);
  ASSERT_FALSE(one->findings.empty()) << "there is something to compare";
  ASSERT_EQ(one->findings.size(), two->findings.size());
  for (std::size_t k = 0; k < one->findings.size(); ++k) {
    EXPECT_EQ(one->findings[k].cause, two->findings[k].cause);
    EXPECT_EQ(one->findings[k].parameter, two->findings[k].parameter);
    EXPECT_EQ(one->findings[k].value, two->findings[k].value);
    EXPECT_EQ(one->findings[k].se, two->findings[k].se);
    EXPECT_EQ(one->findings[k].score, two->findings[k].score);
  }
  EXPECT_TRUE(one->extended == two->extended);
  EXPECT_EQ(one->gyro_noise, two->gyro_noise);
  EXPECT_EQ(one->force_noise, two->force_noise);
  ASSERT_EQ(one->rungs.size(), two->rungs.size());
  for (std::size_t k = 0; k < one->rungs.size(); ++k) {
    EXPECT_EQ(one->rungs[k].kept, two->rungs[k].kept);
    ASSERT_EQ(one->rungs[k].durations.size(), two->rungs[k].durations.size());
    for (std::size_t d = 0; d < one->rungs[k].durations.size(); ++d) {
      EXPECT_EQ(one->rungs[k].durations[d].held_out_log_score, two->rungs[k].durations[d].held_out_log_score);
    }
  }
  expect_same(one->simulated_after, two->simulated_after);
}

}  // namespace
}  // namespace driftlab::drive
