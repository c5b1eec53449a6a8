#include "core/investigate/causes/cause.hpp"
#include "core/investigate/investigate.hpp"
#include "core/process/random.hpp"

#include <gtest/gtest.h>

#include <string>

namespace driftlab::investigate {
namespace {

/// A recorded IMU froze at 196.9 s for the rest of the file; one run was too few to be called stuck, and the frozen
/// part was taken for noise.
TEST(Freeze, IsOneStuckRunAndSpoilsNothingElse) {
  Random random(8);
  std::vector<double> rate(6000);
  for (std::size_t i = 0; i < rate.size(); ++i) {
    rate[i] = i < 2000 ? 0.1 * random.normal() : rate[1999];
  }
  RecordingSpec spec;
  spec.id = "a";
  spec.rate_hz = 20.0;
  spec.columns["gz"] = {Quantity::AngularRate, "z", *parse_unit("deg/s")};
  Study study;
  study.id = "frozen";
  study.recordings.push_back(
      *make_study_recording(spec, {"gz"}, rate.size(), [&](std::size_t) { return std::span<const double>(rate); }));
  settle_channels(study);
  const auto report = investigate(study);
  ASSERT_TRUE(report);
  ASSERT_EQ(report->findings.size(), 1U);
  const Finding& finding = report->findings[0];
  EXPECT_EQ(finding.evidence.cause->name, "stuck_samples");
  EXPECT_NEAR(finding.evidence.parameters[0].estimate.value, 4000.0 / 6000.0, 1e-3);
  EXPECT_LE(finding.evidence.parameters[0].estimate.ci95.high, 1.0);
  EXPECT_NE(finding.explanation.find("begins 100.0 s after the first sample"), std::string::npos)
      << finding.explanation;
}

}  // namespace
}  // namespace driftlab::investigate
