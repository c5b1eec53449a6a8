#include "core/investigate/causes/cause.hpp"
#include "core/investigate/investigate.hpp"
#include "core/process/random.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

namespace driftlab::investigate {
namespace {

constexpr double kRateHz = 20.0;
constexpr std::size_t kSamples = 6000;

/// White noise of 0.1 deg/s and a line at 3 Hz until the sensor freezes.
std::vector<double> frozen_after(std::size_t alive, double line) {
  Random random(8);
  std::vector<double> rate(kSamples);
  for (std::size_t i = 0; i < rate.size(); ++i) {
    const double phase = 2.0 * std::numbers::pi * 3.0 * static_cast<double>(i) / kRateHz;
    rate[i] = i < alive ? 0.1 * random.normal() + line * std::sin(phase) : rate[alive - 1];
  }
  return rate;
}

Study study_of(const std::vector<double>& rate) {
  RecordingSpec spec;
  spec.id = "a";
  spec.rate_hz = kRateHz;
  spec.columns["gz"] = {Quantity::AngularRate, "z", *parse_unit("deg/s")};
  Study study;
  study.id = "frozen";
  study.recordings.push_back(
      *make_study_recording(spec, {"gz"}, rate.size(), [&](std::size_t) { return std::span<const double>(rate); }));
  settle_channels(study);
  return study;
}

/// A recorded IMU froze at 196.9 s for the rest of the file; one run was too few to be called stuck, and the frozen
/// part was taken for noise.
TEST(Freeze, IsOneStuckRunAndSpoilsNothingElse) {
  const std::vector<double> rate = frozen_after(2000, 0.0);
  const auto report = investigate(study_of(rate));
  ASSERT_TRUE(report);
  ASSERT_EQ(report->findings.size(), 1U);
  const Finding& finding = report->findings[0];
  EXPECT_EQ(finding.evidence.cause->name, "stuck_samples");
  EXPECT_NEAR(finding.evidence.parameters[0].estimate.value, 4000.0 / 6000.0, 1e-3);
  EXPECT_LE(finding.evidence.parameters[0].estimate.ci95.high, 1.0);
  EXPECT_NE(finding.explanation.find("begins 100.0 s after the first sample"), std::string::npos)
      << finding.explanation;
}

/// Half of the recording holds no sample in use; the gains are of the part that lives. An oracle gains A^2 n / (4 s^2).
TEST(Freeze, LeavesWhatIsFoundBeforeItAGain) {
  const std::vector<double> rate = frozen_after(2400, 0.04);
  const auto report = investigate(study_of(rate));
  ASSERT_TRUE(report);
  ASSERT_EQ(report->findings.size(), 2U);
  EXPECT_GT(report->findings[0].gain.log_score_per_sample, 0.5);
  const Finding& line = report->findings[1];
  ASSERT_EQ(line.evidence.cause->name, "periodic_disturbance");
  EXPECT_TRUE(line.evidence.parameters[0].estimate.ci95.contains(0.04 * std::numbers::pi / 180.0));
  const double oracle = 0.25 * 2400.0 * 0.16;
  EXPECT_NEAR(line.gain.log_score_per_sample * line.gain.samples, oracle, 0.35 * oracle);
}

}  // namespace
}  // namespace driftlab::investigate
