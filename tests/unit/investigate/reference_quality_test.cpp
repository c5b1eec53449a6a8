#include "core/investigate/study/reference_quality.hpp"

#include "core/investigate/causes/cause.hpp"
#include "core/investigate/investigate.hpp"
#include "core/process/random.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

namespace driftlab::investigate {
namespace {

constexpr double kDt = 0.02;

/// A gyroscope of 0.1 deg/s of white noise that measures `truth`, beside a reference column [deg/s].
Study beside(const std::vector<double>& truth, const std::vector<double>& reference, std::vector<double>& measured) {
  Random random(21);
  measured = truth;
  for (double& w : measured) {
    w += 0.1 * random.normal();
  }
  const std::array<std::span<const double>, 2> columns{measured, reference};
  RecordingSpec spec;
  spec.id = "table";
  spec.rate_hz = 1.0 / kDt;
  spec.condition.kind = ConditionKind::Profile;
  spec.columns["gz"] = {Quantity::AngularRate, "z", *parse_unit("deg/s")};
  spec.columns["rz"] = {Quantity::ReferenceAngularRate, "z", *parse_unit("deg/s")};
  Study study;
  study.id = "reference";
  study.recordings.push_back(
      *make_study_recording(spec, {"gz", "rz"}, truth.size(), [&](std::size_t i) { return columns.at(i); }));
  settle_channels(study);
  return study;
}

std::vector<double> sway(double period_s) {
  std::vector<double> rate(20000);
  for (std::size_t i = 0; i < rate.size(); ++i) {
    const double t = static_cast<double>(i) * kDt;
    rate[i] = 10.0 * std::sin(6.283185307179586 * t / period_s) * std::sin(0.011 * t);
  }
  return rate;
}

bool names(const Report& report, std::string_view cause) {
  return std::any_of(report.findings.begin(), report.findings.end(),
                     [&](const Finding& finding) { return finding.evidence.cause->name == cause; });
}

TEST(ReferenceQuality, ThirdDifferencesSeeNoiseAndNoMotion) {
  Random random(3);
  std::vector<double> values(50000);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double t = static_cast<double>(i) * kDt;
    values[i] = 3.0 + 2.0 * t - 0.1 * t * t + 0.5 * random.normal();
  }
  // Variance of the squared third difference: lags 1 to 3 correlate by -0.75, 0.3, -0.05, so edf = n / 2.3.
  EXPECT_NEAR(noise_of_third_differences(values, 0, values.size()), 0.5, 4.0 * 0.5 * std::sqrt(0.5 * 2.4 / 50000.0));
}

/// A turntable's encoder, differenced: noisier than the gyroscope. Regressing on it would give a scale factor of
/// -s^2 / var(reference) = -0.9 / 25 that the sensor does not have.
TEST(ReferenceQuality, ANoisyReferenceShowsNoScaleFactor) {
  const std::vector<double> truth = sway(40.0);
  std::vector<double> reference = truth;
  Random random(5);
  for (double& w : reference) {
    w += 0.95 * random.normal();
  }
  std::vector<double> measured;
  const auto report = investigate(beside(truth, reference, measured));
  ASSERT_TRUE(report);
  EXPECT_FALSE(names(*report, "scale_factor_error"));
  EXPECT_FALSE(names(*report, "scale_factor_asymmetry"));
  EXPECT_FALSE(names(*report, "scale_factor_nonlinearity"));
  EXPECT_TRUE(std::any_of(report->not_examined.begin(), report->not_examined.end(), [](const NotExamined& item) {
    return item.cause == "scale_factor_error" && item.needs.find("less noise") != std::string::npos;
  }));
}

TEST(ReferenceQuality, AReferenceOfAnotherMotionGivesNoFindings) {
  std::vector<double> measured;
  const auto report = investigate(beside(sway(40.0), sway(29.0), measured));
  ASSERT_TRUE(report);
  EXPECT_TRUE(report->findings.empty());
  ASSERT_FALSE(report->notes.empty());
  EXPECT_NE(report->notes.back().find("does not follow its reference"), std::string::npos) << report->notes.back();
}

TEST(ReferenceQuality, AnErrorOfHalfTheRateIsNoScaleFactor) {
  const std::vector<double> truth = sway(40.0);
  std::vector<double> reference = truth;
  for (double& w : reference) {
    w *= 0.5;
  }
  std::vector<double> measured;
  const auto report = investigate(beside(truth, reference, measured));
  ASSERT_TRUE(report);
  EXPECT_FALSE(names(*report, "scale_factor_error"));
  EXPECT_FALSE(report->unexplained.empty() && report->findings.empty());
}

}  // namespace
}  // namespace driftlab::investigate
