// Causes hidden in a simulated drive are named with their size; a drive of the model it was made from names none.
#include "tests/unit/navigate/drive_fixture.hpp"

namespace driftlab::drive {
namespace {

struct HiddenCase {
  const char* cause;
  const char* parameter;
  double value;  ///< lab unit
  double tolerance;
  Hidden hidden;
};

const DriveFinding* finding_of(const SearchResult& result, const std::string& cause, const std::string& parameter) {
  for (const DriveFinding& finding : result.findings) {
    if (finding.cause == cause && finding.parameter == parameter) {
      return &finding;
    }
  }
  return nullptr;
}

TEST(DriveCauses, AreNamedWithTheirSize) {
  ReadingErrors scale;
  scale.gyroscope(2, 2) = 0.02;
  ReadingErrors cross;
  cross.gyroscope(0, 2) = 0.02;
  const HiddenCase cases[] = {
      {"imu_time_offset", "delta_s", 0.03, 0.006, {.imu_offset_s = 0.03}},
      {"gnss_velocity_latency", "delay_s", 0.06, 0.01, {.velocity_latency_s = 0.06}},
      {"gnss_lever_arm", "x", 0.4, 0.05, {.lever_arm_m = {0.4, 0.0, 0.0}}},
      {"gyro_scale_factor_error", "z", 2.0, 0.4, {.errors = scale}},
      {"gyro_axis_misalignment", "xz", 2.0, 0.6, {.errors = cross}},
  };
  std::uint64_t seed = 31;
  for (const HiddenCase& one : cases) {
    const Drive drive = simulated_drive(seed++, one.hidden);
    const auto result = search_causes(drive, options_of(drive.document), 4);
    ASSERT_TRUE(result) << result.error().message;
    ASSERT_FALSE(result->findings.empty()) << one.cause;
    EXPECT_EQ(result->findings.front().cause, one.cause);
    const DriveFinding* const finding = finding_of(*result, one.cause, one.parameter);
    ASSERT_NE(finding, nullptr) << one.cause;
    EXPECT_NEAR(finding->value, one.value, one.tolerance) << one.cause;
    EXPECT_GE(finding->score, 5.0);
  }
}

TEST(DriveCauses, AreSilentOnADriveOfTheModelItself) {
  for (const std::uint64_t seed : {41, 42, 43}) {
    const Drive drive = simulated_drive(seed);
    const auto result = search_causes(drive, options_of(drive.document), 4);
    ASSERT_TRUE(result);
    EXPECT_TRUE(result->findings.empty()) << result->findings.front().cause << " " << result->findings.front().value;
    EXPECT_NEAR(result->options.gyro_noise, 1.0, 0.25);
  }
}

TEST(DriveCauses, TheFixesAloneShowTheDelayOfTheirVelocities) {
  const Drive late = simulated_drive(51, {.velocity_latency_s = 0.1});
  const auto delay = delay_from_fixes(late.fixes);
  ASSERT_TRUE(delay);
  EXPECT_NEAR(delay->delay_s, 0.1, 0.01);
  EXPECT_NEAR(delay->along_s, 0.1, 0.02);
  EXPECT_NEAR(delay->across_s, 0.1, 0.02);
  const auto none = delay_from_fixes(simulated_drive(52).fixes);
  ASSERT_TRUE(none);
  EXPECT_LT(none->score, 5.0);
}

TEST(DriveCauses, EveryKnobTurnsOneNumberAndBack) {
  for (const Knob& knob : all_knobs()) {
    FilterOptions options;
    options.constraint.emplace();
    knob.turn(options, 0.25);
    knob.turn(options, -0.25);
    EXPECT_EQ(options.imu_offset_s, 0.0);
    EXPECT_EQ(options.velocity_latency_s, 0.0);
    EXPECT_EQ(options.lever_arm_m, Vector3::Zero());
    EXPECT_TRUE(options.errors.none());
    EXPECT_EQ(find_knob(knob.cause, knob.parameter), &knob);
    EXPECT_FALSE(knob.told_apart.empty());
  }
}

}  // namespace
}  // namespace driftlab::drive
