// Each cause of drives is hidden in a simulated drive by independent code and named first by the whole
// explanation, with its size; a drive that hides nothing gets no name.
#include "tests/unit/navigate/drive_injections.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace driftlab::drive {
namespace {

constexpr int kLaps = 4;

DriveExplanation explained(Drive drive, bool constraint) {
  drive.document.outages.duration_s = {10.0};
  drive.document.outages.every_s = {40.0};
  drive.document.outages.phases = 2;
  ExplainOptions options;
  options.simulated_runs = 1;
  options.constraint = constraint;
  options.most_causes = 4;
  auto result = explain_drive(drive, drive, options);
  EXPECT_TRUE(result) << result.error().message;
  return result ? std::move(*result) : DriveExplanation{};
}

std::string names_of(const std::vector<DriveFinding>& findings) {
  std::string names;
  for (const DriveFinding& finding : findings) {
    names += finding.cause + " (" + finding.parameter + ") " + std::to_string(finding.value) + " +- " +
             std::to_string(finding.se) + ", score " + std::to_string(finding.score) +
             (finding.pair.empty() ? "" : " or " + finding.pair) + "; ";
  }
  return names;
}

class HiddenInADrive : public ::testing::TestWithParam<DriveInjection> {};

TEST_P(HiddenInADrive, IsNamedFirstWithItsSize) {
  const DriveInjection& hidden = GetParam();
  const DriveExplanation result = explained(hidden.drive(71, hidden.clear, kLaps), hidden.constraint);
  ASSERT_FALSE(result.findings.empty());
  const DriveFinding& first = result.findings.front();
  EXPECT_EQ(first.cause, hidden.cause) << names_of(result.findings);
  EXPECT_EQ(first.parameter, hidden.parameter) << names_of(result.findings);
  EXPECT_NEAR(first.value, hidden.reported, hidden.within) << names_of(result.findings);
  EXPECT_TRUE(first.pair.empty()) << names_of(result.findings);
  EXPECT_FALSE(first.at_bound);
  for (const DriveFinding& finding : result.findings) {
    const bool is_there = finding.cause == hidden.cause || finding.cause == hidden.beside;
    EXPECT_TRUE(is_there || (!hidden.beside.empty() && finding.pair == hidden.beside)) << names_of(result.findings);
  }
}

INSTANTIATE_TEST_SUITE_P(Causes, HiddenInADrive, ::testing::ValuesIn(drive_injections()),
                         [](const auto& hidden) { return hidden.param.cause + "_" + hidden.param.parameter; });

struct Unhidden {
  const char* name;
  bool constraint, odometer;
};

class NothingHiddenInADrive : public ::testing::TestWithParam<Unhidden> {};

TEST_P(NothingHiddenInADrive, GetsNoName) {
  const Unhidden& given = GetParam();
  const Drive drive = given.odometer ? with_odometer(72, 0.0, 0.0, kLaps) : simulated_drive(72, {}, kLaps);
  const DriveExplanation result = explained(drive, given.constraint);
  EXPECT_TRUE(result.findings.empty()) << names_of(result.findings);
  EXPECT_NEAR(result.gyro_noise, 1.0, 0.2);
  EXPECT_NEAR(result.force_noise, 1.0, 0.2);
}

INSTANTIATE_TEST_SUITE_P(With, NothingHiddenInADrive,
                         ::testing::Values(Unhidden{"fixes_alone", false, false},
                                           Unhidden{"velocity_constraints", true, false},
                                           Unhidden{"an_odometer", false, true}),
                         [](const auto& given) { return std::string(given.param.name); });

}  // namespace
}  // namespace driftlab::drive
