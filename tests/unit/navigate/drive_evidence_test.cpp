// What the fixes at rest and the outages say of a cause beside the innovations.
#include "core/navigate/drive/rest_correlation.hpp"
#include "core/navigate/drive/vibration_thirds.hpp"
#include "tests/unit/navigate/drive_injections.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace driftlab::drive {
namespace {

constexpr double kStill = 0.5;  // [m], of the fixes

/// Rests of `length_s` seconds each, a turn of the unit between two, and 4 Hz fixes whose errors last for `tau_s`; 0:
/// they are white.
Drive resting_drive(std::uint64_t seed, int rests, double length_s, double tau_s) {
  Drive drive;
  Random random(seed);
  UniformRun run{0.0, 0.01, {}};
  for (int rest = 0; rest < rests; ++rest) {
    for (double time_s = 0.0; time_s < length_s; time_s += run.dt_s) {
      const double turning = time_s < 1.0 && rest > 0 ? 0.5 : 0.0;
      run.readings.push_back({0.0, 0.0, turning + 1e-3 * random.normal(), 0.0, 0.0, -9.81});
    }
  }
  const Vector3 place = to_ecef({48.0 * kDegree, 9.0 * kDegree, 300.0});
  Vector3 error = Vector3::Zero();
  double phi = 0.0;
  for (double time_s = 0.125; time_s < run.end_s(); time_s += 0.25) {
    error =
        phi * error + kStill * std::sqrt(1.0 - phi * phi) * Vector3(random.normal(), random.normal(), random.normal());
    phi = tau_s > 0.0 ? std::exp(-0.25 / tau_s) : 0.0;
    Fix fix;
    fix.time_s = time_s;
    fix.position_ecef_m = place + error;
    drive.fixes.push_back(fix);
  }
  drive.runs.push_back(std::move(run));
  return drive;
}

TEST(RestCorrelation, OfLastingErrorsFallsAsTheirOwn) {
  // 800 fixes of three axes. By Bartlett's formula for a Gauss-Markov series, var r_k = ((1 + f^2)(1 - f^2k)/(1 - f^2)
  // - 2 k f^2k)/n with f = exp(-0.25/3): 0.027 at a second and 0.055 near 3 s, where r falls by 0.12 a second. The mean
  // of each rest takes 2 tau/T = 0.03 of what is left of 1.
  const auto found = rest_correlation(resting_drive(81, 1, 200.0, 3.0));
  ASSERT_TRUE(found);
  EXPECT_EQ(found->rests, 1U);
  EXPECT_NEAR(found->seconds, 200.0, 1.0);
  EXPECT_NEAR(found->after_1s, std::exp(-1.0 / 3.0), 3.0 * 0.027 + 0.01);
  ASSERT_TRUE(found->lasts_s);
  EXPECT_NEAR(*found->lasts_s, 3.0, (3.0 * 0.055 + 0.02) / 0.12);
}

TEST(RestCorrelation, IsPooledOverRests) {
  const auto found = rest_correlation(resting_drive(82, 4, 50.0, 1.0));
  ASSERT_TRUE(found);
  EXPECT_EQ(found->rests, 4U);
  // As above with f = exp(-0.25): 0.025 at a second; 2 tau/T = 0.04 of 0.63.
  EXPECT_NEAR(found->after_1s, std::exp(-1.0), 3.0 * 0.025 + 0.03);
}

TEST(RestCorrelation, OfWhiteErrorsIsNone) {
  const auto found = rest_correlation(resting_drive(83, 1, 200.0, 0.0));
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->after_1s, 0.0, 3.0 / std::sqrt(2400.0) + 1.0 / 800.0);
  ASSERT_TRUE(found->lasts_s);
  EXPECT_LT(*found->lasts_s, 0.25) << "the next fix";
}

TEST(RestCorrelation, NeedsRestsOfTwentySecondsAndFixesThatDiffer) {
  EXPECT_FALSE(rest_correlation(resting_drive(84, 8, 15.0, 3.0)));
  Drive equal = resting_drive(84, 1, 60.0, 3.0);
  for (Fix& fix : equal.fixes) {
    fix.position_ecef_m = equal.fixes.front().position_ecef_m;
  }
  EXPECT_FALSE(rest_correlation(equal));
  Drive sparse = resting_drive(84, 1, 60.0, 3.0);
  for (std::size_t i = 0; i < sparse.fixes.size(); ++i) {
    sparse.fixes[i].time_s *= 8.0;
  }
  EXPECT_FALSE(rest_correlation(sparse)) << "a fix in 2 s";
}

DurationSummary outages_of(const Drive& drive) {
  EvaluationOptions settings;
  settings.resamples = 0;
  auto evaluation = evaluate_drive(drive, {}, settings);
  EXPECT_TRUE(evaluation) << evaluation.error().message;
  return evaluation ? std::move(evaluation->durations.front()) : DurationSummary{};
}

/// Ten seconds in every forty, so that outages lie in calm and in shaken parts.
Drive with_short_outages(Drive drive) {
  drive.document.outages.duration_s = {10.0};
  drive.document.outages.every_s = {40.0};
  drive.document.outages.phases = 4;
  return drive;
}

TEST(VibrationThirds, TheShakenOneErrsMoreWhereTheNoiseFollowsTheVibration) {
  // 49 times the noise power in a third of each minute; what is shaken shortly before an outage counts in a calm one
  // too. The rms of n = 18 outages scatters by 1/(2 sqrt(n)) = 0.12, that of two equal thirds over each other by 0.17:
  // beyond 1.5 they are not equal.
  const Drive drive = with_short_outages(shaken_drive(85, 16.0, 6, 0));
  const auto thirds = errors_by_vibration(drive, outages_of(drive));
  ASSERT_TRUE(thirds);
  EXPECT_EQ(thirds->duration_s, 10.0);
  EXPECT_LT(thirds->power[0], thirds->power[1]);
  EXPECT_LT(thirds->power[1], thirds->power[2]);
  EXPECT_GT(thirds->power[2], 1.5);
  EXPECT_GT(thirds->count[0], 15U);
  EXPECT_GT(thirds->rms_m[2], 1.5 * thirds->rms_m[0]);
  EXPECT_NEAR(static_cast<double>(thirds->count[0]), static_cast<double>(thirds->count[2]), 1.0);
}

TEST(VibrationThirds, ErrAlikeUnderALevel) {
  Hidden loud;
  loud.noise_factor = 4.0;
  const Drive drive = with_short_outages(simulated_drive(86, loud, 6));
  const auto thirds = errors_by_vibration(drive, outages_of(drive));
  ASSERT_TRUE(thirds);
  EXPECT_NEAR(thirds->power[2], 1.0, 0.3);
  EXPECT_LT(thirds->rms_m[2], 1.5 * thirds->rms_m[0]);
  EXPECT_GT(thirds->rms_m[2], thirds->rms_m[0] / 1.5);
}

TEST(VibrationThirds, NeedNineOutages) {
  const Drive drive = with_short_outages(simulated_drive(87, {}, 6));
  DurationSummary few = outages_of(drive);
  ASSERT_GT(few.outages.size(), 8U);
  few.outages.resize(8);
  EXPECT_FALSE(errors_by_vibration(drive, few));
}

DriveExplanation explained(Drive drive) {
  ExplainOptions options;
  options.simulated_runs = 1;
  options.most_causes = 2;
  drive = with_short_outages(std::move(drive));
  auto result = explain_drive(drive, drive, options);
  EXPECT_TRUE(result) << result.error().message;
  return result ? std::move(*result) : DriveExplanation{};
}

TEST(DriveEvidence, OfLastingErrorsSaysHowTheyLastAtRest) {
  const DriveExplanation result = explained(with_lasting_errors(88, 0.5, 20.0, 4));
  ASSERT_FALSE(result.findings.empty());
  EXPECT_THAT(
      result.findings.front().evidence,
      ::testing::ContainsRegex("^innovations; at rest \\(once, .* s in all\\) positions correlate by .* after 1 s"));
}

TEST(DriveEvidence, OfLateVelocitiesOffersAMeanBesideADelay) {
  Drive drive = simulated_drive(63, {}, 3);
  const std::vector<Fix> fixes = drive.fixes;
  for (std::size_t i = 1; i < fixes.size(); ++i) {
    const Vector3 moved = fixes[i].position_ecef_m - fixes[i - 1].position_ecef_m;
    drive.fixes[i].velocity_ned_m_s =
        ned_axes(fixes[i].position_ecef_m).transpose() * moved / (fixes[i].time_s - fixes[i - 1].time_s);
  }
  const auto found = find_cause("gnss_velocity_latency")->from_files(drive, {});
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->finding.value, 0.125, std::max(0.005, 3.0 * found->finding.se)) << "half of the fixes' interval";
  EXPECT_THAT(found->finding.evidence, ::testing::HasSubstr("means over the 0.2"));
  drive.fixes = fixes;
  EXPECT_FALSE(find_cause("gnss_velocity_latency")->from_files(drive, {}));
}

TEST(DriveEvidence, OfNoiseThatFollowsTheVibrationIsANoteOnceAndOfNothingElse) {
  const auto thirds_in = [](const DriveExplanation& result) {
    return std::count_if(result.notes.begin(), result.notes.end(),
                         [](const std::string& note) { return note.find("shaken third") != std::string::npos; });
  };
  EXPECT_EQ(thirds_in(explained(shaken_drive(89, 5.0, 4, 0))), 1);
  Hidden late;
  late.imu_offset_s = 0.05;
  const DriveExplanation other = explained(simulated_drive(90, late, 4));
  ASSERT_FALSE(other.findings.empty());
  EXPECT_EQ(thirds_in(other), 0);
  EXPECT_EQ(other.findings.front().evidence, "innovations");
}

}  // namespace
}  // namespace driftlab::drive
