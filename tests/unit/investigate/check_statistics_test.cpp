#include "core/investigate/causes/cause.hpp"
#include "core/investigate/report/checks.hpp"
#include "core/investigate/search/thresholds.hpp"
#include "tests/unit/investigate/noise_at_full_rate.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

namespace driftlab::investigate {
namespace {

using testing::HasSubstr;

/// The checks of these innovations, taken as those before and after the search.
Report checks_of(std::vector<std::vector<double>> innovations, const std::vector<Evidence>& examined = {}) {
  const NoiseAtFullRate noise(std::move(innovations));
  GroupOutcome outcome;
  outcome.usable = true;
  outcome.before = noise.data;
  outcome.after = noise.data;
  Report report;
  make_checks({noise.group}, {outcome}, {check_channel(noise.group, outcome)}, examined, report);
  return report;
}

Check named(const Report& report, const std::string& id) {
  const auto found =
      std::find_if(report.checks.begin(), report.checks.end(), [&](const Check& check) { return check.id == id; });
  EXPECT_NE(found, report.checks.end()) << id;
  return found != report.checks.end() ? *found : report.checks.front();
}

TEST(CheckStatistics, UnderARightModelEachFailsAsOftenAsItSays) {
  // p below 0.05 in 5 % of 300 recordings: 15, with a standard deviation of 3.8, at most 31; and not never. The same
  // over all checks of a study together after the adjustment: at most 5 % of studies fail any.
  constexpr int kStudies = 300;
  std::map<std::string, int> seen;
  int studies = 0;
  for (std::uint64_t i = 0; i < kStudies; ++i) {
    const Report report = checks_of({white(6000, 71, i)});
    studies += report.failed_before > 0 ? 1 : 0;
    for (const Check& check : report.checks) {
      seen[check.id] += check.p < 0.05 ? 1 : 0;
      ASSERT_GE(check.p_adjusted, check.p);
      ASSERT_EQ(check.failed, check.p_adjusted < 0.05);
      ASSERT_LE(check.q025, check.median);
      ASSERT_LE(check.median, check.q975);
    }
  }
  EXPECT_GE(seen.size(), 8U);
  for (const auto& [id, count] : seen) {
    EXPECT_LE(count, 31) << id;
    EXPECT_GE(count, 2) << id;
  }
  EXPECT_LE(studies, 31);
}

TEST(CheckStatistics, EachSeesWhatItIsThereFor) {
  constexpr std::size_t kCount = 20000;
  std::vector<double> louder = white(kCount, 73, 0);
  for (std::size_t i = kCount / 2; i < kCount; ++i) {
    louder[i] *= 1.1;
  }
  std::vector<double> coloured = white(kCount, 73, 1);
  for (std::size_t i = kCount; i-- > 1;) {
    coloured[i] = (coloured[i] - 0.2 * coloured[i - 1]) / std::sqrt(1.04);
  }
  std::vector<double> wandering = white(kCount, 73, 2);
  double slow = 0.0;
  Random random(73, 3);
  for (double& value : wandering) {  // correlated over 500 samples, a twentieth of the variance
    slow += -slow / 500.0 + std::sqrt(2.0 / 500.0) * random.normal();
    value = (value + std::sqrt(0.05) * slow) / std::sqrt(1.05);
  }
  std::vector<double> heavy(kCount);
  for (double& value : heavy) {
    value = random.student(8.0) * std::sqrt(6.0 / 8.0);
  }
  EXPECT_TRUE(named(checks_of({louder}), "r0/gz.variance_over_time").failed);
  EXPECT_TRUE(named(checks_of({coloured}), "r0/gz.spectrum").failed);
  EXPECT_TRUE(named(checks_of({wandering}), "r0/gz.whiteness").failed);
  EXPECT_TRUE(named(checks_of({wandering}), "r0/gz.whiteness").of_slow_misfit);
  EXPECT_FALSE(named(checks_of({wandering}), "r0/gz.kurtosis").of_slow_misfit);
  EXPECT_TRUE(named(checks_of({wandering}), "r0/gz.wavelet_variance_20.5s").failed);
  const Check tails = named(checks_of({heavy}), "r0/gz.kurtosis");
  EXPECT_TRUE(tails.failed);
  EXPECT_NEAR(tails.observed, 6.0 / (8.0 - 4.0), 0.5);  // the t's excess; its own scatter at n = 20000 is 0.15
  EXPECT_FALSE(named(checks_of({louder}), "r0/gz.whiteness").failed);
  EXPECT_FALSE(named(checks_of({coloured}), "r0/gz.variance_over_time").failed);
}

/// Normal noise rounded to a lattice as coarse as 1.8 of its deviations has an excess kurtosis between -0.19 and +0.09,
/// by where its mean stands; that of an independent uniform error would be -0.055. The check's own deviation is 0.022.
TEST(CheckStatistics, ACoarseLatticeHasTheTailsOfRounding) {
  constexpr double kStep = 1.8;
  for (const double mean : {0.0, 0.5 * kStep}) {
    std::vector<double> rounded = white(50000, 83);
    for (double& value : rounded) {
      value = kStep * std::round((value + mean) / kStep) - mean;
    }
    const double variance = 1.0 + kStep * kStep / 12.0;
    NoiseAtFullRate noise({rounded});
    noise.channels[0].measured = Series(rounded).minus(-mean);
    noise.data.lattice_step = kStep;
    noise.data.model.white = variance * noise.data.dt_s;
    noise.data.innovation_sd = std::sqrt(variance);
    for (double& value : rounded) {
      value /= std::sqrt(variance);
    }
    noise.data.innovation[0] = rounded;
    std::vector<Check> checks;
    general_checks(noise.group, noise.data, checks);
    const auto tails =
        std::find_if(checks.begin(), checks.end(), [](const Check& check) { return check.id == "r0/gz.kurtosis"; });
    ASSERT_NE(tails, checks.end());
    EXPECT_GT(tails->p, 1e-3) << "mean " << mean << ": " << tails->observed << " against " << tails->median;
    EXPECT_GT(std::fabs(tails->observed + 1.2 * std::pow(kStep * kStep / 12.0 / variance, 2.0)), 0.08);
  }
}

TEST(CheckStatistics, OnlyTheRecordingThatIsWrongFails) {
  std::vector<double> louder = white(20000, 79, 1);
  std::for_each(louder.begin() + 10000, louder.end(), [](double& v) { v *= 1.2; });
  const Report report = checks_of({white(20000, 79, 0), louder});
  EXPECT_FALSE(named(report, "r0/gz.variance_over_time").failed);
  const Check check = named(report, "r1/gz.variance_over_time");
  EXPECT_TRUE(check.failed);
  EXPECT_EQ(check.recording, "r1");
  EXPECT_EQ(check.channel, "gz");
  // What was left after the search is the same here, so it is said to be unexplained.
  ASSERT_EQ(report.unexplained.size(), 1U);
  EXPECT_THAT(report.unexplained.front().checks, testing::Contains("r1/gz.variance_over_time"));
  EXPECT_THAT(report.unexplained.front().sentence, HasSubstr("does not describe gz"));
}

TEST(CheckStatistics, TheMisfitIsHalfTheExcessOfTheSquaresPerSample) {
  // ln of the Gaussian density of a sample of variance v under a model of variance 1 loses (v - 1)/2 nat on average.
  EXPECT_DOUBLE_EQ(checks_of({std::vector<double>(600, 2.0), std::vector<double>(200, 0.0)}).misfit_after,
                   0.5 * (600.0 * 3.0 - 200.0) / 800.0);
}

TEST(CheckStatistics, AFindingNamesItsOwnCheckFirstAndThenWhatFailedInItsRecordings) {
  std::vector<double> louder = white(20000, 89, 1);
  std::for_each(louder.begin() + 10000, louder.end(), [](double& v) { v *= 1.2; });
  Evidence evidence;
  evidence.cause = &cause_registry().front();
  evidence.members = {1};
  evidence.score = kThreshold + 5.0;
  const NoiseAtFullRate noise({white(20000, 89, 0), louder});
  GroupOutcome outcome;
  outcome.usable = true;
  outcome.before = noise.data;
  outcome.after = noise.data;
  Report report;
  make_checks({noise.group}, {outcome}, {check_channel(noise.group, outcome)}, {evidence}, report);
  const std::vector<std::string> ids = checks_behind(evidence, {noise.group}, report);
  ASSERT_GE(ids.size(), 2U);
  EXPECT_EQ(ids.front(), "gz." + std::string(evidence.cause->name));
  EXPECT_THAT(ids, testing::Contains("r1/gz.variance_over_time"));
  evidence.members = {0};
  EXPECT_EQ(checks_behind(evidence, {noise.group}, report).size(), 1U) << "nothing failed in recording 0";
}

}  // namespace
}  // namespace driftlab::investigate
