/// A name that the evidence does not carry has to be taken back: each reason for it, and how near to it a finding may
/// come, was code whose absence no test would have noticed.
#include "core/investigate/report/earned.hpp"

#include "core/investigate/causes/cause.hpp"
#include "tests/unit/investigate/noise_at_full_rate.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <numbers>
#include <string>
#include <string_view>
#include <vector>

namespace driftlab::investigate {
namespace {

constexpr double kDt = 0.02;
constexpr std::size_t kSamples = 1000;
constexpr double kLongest = 20.0;  // [s]

/// Recordings of one axis, the longest of 20 s, and one finding in it.
class Earned : public testing::Test {
 protected:
  /// Why `evidence` is not earned beside what the test has set; empty: it is.
  std::string doubt(Evidence evidence) {
    std::vector<Evidence> found{std::move(evidence)};
    doubt_what_is_not_earned(groups_, {means_}, remains_, instead_, report_, found);
    EXPECT_EQ(found[0].ambiguous, !found[0].doubt.empty());
    return found[0].doubt;
  }
  static Evidence evidence_of(std::string_view cause) {
    Evidence evidence;
    evidence.cause = find_cause(cause);
    EXPECT_NE(evidence.cause, nullptr) << cause;
    return evidence;
  }
  static Evidence with(Evidence evidence, const std::string& name, double value, const char* unit) {
    evidence.parameters.push_back({name, {value, {value, value}}, {unit, 1.0}});
    return evidence;
  }

  NoiseAtFullRate noise_{
      {std::vector<double>(kSamples), std::vector<double>(kSamples / 2), std::vector<double>(kSamples / 2),
       std::vector<double>(kSamples / 2), std::vector<double>(kSamples / 2)},
      kDt};
  std::vector<ChannelGroup> groups_{noise_.group};
  std::vector<double> means_ = std::vector<double>(5, 0.0);
  std::vector<Remainder> remains_;
  Instead instead_;
  Report report_;
};

TEST_F(Earned, WhatNothingSpeaksAgainstIs) {
  EXPECT_EQ(doubt(with(evidence_of("warm_up_transient"), "tau_s", 5.0, "s")), "");
}

TEST_F(Earned, ATimeBeyondTwentyRecordingsIsAtTheBoundOfItsSearch) {
  const std::string at_bound = "a parameter is at the bound of its search";
  for (const double side : {1.0, -1.0}) {
    EXPECT_EQ(doubt(with(evidence_of("warm_up_transient"), "tau_s", side * 20.01 * kLongest, "s")), at_bound);
    EXPECT_EQ(doubt(with(evidence_of("warm_up_transient"), "tau_s", side * 19.99 * kLongest, "s")), "");
  }
  EXPECT_EQ(doubt(with(evidence_of("gauss_markov"), "beta", 20.01 * kLongest, "1/s")), "") << "no time";
  EXPECT_EQ(doubt(with(evidence_of("gauss_markov"), "beta", std::numeric_limits<double>::quiet_NaN(), "1/s")),
            at_bound);
  EXPECT_EQ(doubt(with(evidence_of("gauss_markov"), "beta", std::numeric_limits<double>::infinity(), "1/s")), at_bound);
}

TEST_F(Earned, AnEstimateBelowWhatItsCauseDeclaresIsAtTheBoundToo) {
  const Evidence tails = evidence_of("heavy_tailed_noise");
  const double least = tails.cause->parameters[0].doubtful_below;
  ASSERT_GT(least, 2.0) << "a t of two degrees of freedom has no variance";
  EXPECT_NE(doubt(with(tails, "nu", 0.999 * least, "1")), "");
  EXPECT_EQ(doubt(with(tails, "nu", 1.001 * least, "1")), "");
  EXPECT_EQ(doubt(with(tails, "another", 0.0, "1")), "") << "that holds of the declared parameter alone";
}

/// Of squares d^2 and 1 about a median of 0 the larger is 1/(1 + d^2) of the sum: 0.954 at d = 0.22, 0.946 at 0.24.
TEST_F(Earned, ABiasOfEveryRecordingThatIsOneRecordingsIsNot) {
  const Evidence biases = evidence_of("turn_on_bias");
  means_ = {0.0, 0.0, 0.22, -1.0, 0.0};
  EXPECT_EQ(doubt(biases), "it is carried by r3 alone");
  for (double& mean : means_) {
    mean += 7.0;
  }
  EXPECT_EQ(doubt(biases), "it is carried by r3 alone") << "wherever the median lies";
  EXPECT_EQ(doubt(evidence_of("gauss_markov")), "") << "which may wander in one recording alone";
  means_ = {0.0, 0.0, 0.24, -1.0, 0.0};
  EXPECT_EQ(doubt(biases), "");
  means_ = {0.0, 1.0, 0.0};
  EXPECT_EQ(doubt(biases), "") << "of three one always lies far from the median";
  means_ = {0.0, 1.0, 0.0, 0.0};
  EXPECT_EQ(doubt(biases), "it is carried by r1 alone");
}

TEST_F(Earned, ALineThatComesAWholeNumberOfTimesATurnIsNot) {
  // 4 turns in 20 s, and 2 in the recordings half as long.
  const auto turning = [&](std::size_t r, double turns_per_s) {
    StudyRecording& recording = noise_.recordings[r];
    std::vector<double> angle(recording.length);
    for (std::size_t i = 0; i < recording.length; ++i) {
      angle[i] = 2.0 * std::numbers::pi * turns_per_s * recording.time_s(i);
    }
    recording.angle = std::move(angle);
  };
  const auto line = [&](double frequency_hz, double half_width, std::vector<std::size_t> members) {
    Evidence evidence = evidence_of("periodic_disturbance");
    evidence.members = std::move(members);
    evidence.parameters.push_back(
        {"frequency_hz", {frequency_hz, {frequency_hz - half_width, frequency_hz + half_width}}, {"Hz", 1.0}});
    return doubt(evidence);
  };
  EXPECT_EQ(line(0.8, 0.001, {0}), "") << "nothing turns";
  turning(0, 0.2);
  EXPECT_EQ(line(0.8, 0.001, {0}), "it comes 4 times a turn, as what goes with the angle does");
  EXPECT_EQ(line(0.2, 0.001, {0}), "it comes once a turn, as what goes with the angle does");
  EXPECT_EQ(line(0.9, 0.001, {0}), "") << "four times and a half";
  EXPECT_EQ(line(0.8 + 0.0015, 0.001, {0}).substr(0, 8), "it comes");
  EXPECT_EQ(line(0.8 + 0.0025, 0.001, {0}), "") << "beyond three standard errors";
  EXPECT_EQ(line(2.4, 0.001, {0}).substr(0, 8), "it comes");
  EXPECT_EQ(line(2.6, 0.001, {0}), "") << "more than twelve times";
  EXPECT_EQ(line(0.8, 0.001, {0, 1}), "") << "it is there without a turn too";
  turning(1, 0.2);
  EXPECT_EQ(line(0.8, 0.001, {0, 1}), "") << "of a turn or two nothing can be said";
  turning(1, 0.4);
  EXPECT_EQ(line(0.8, 0.001, {0, 1}), "it comes 2 times a turn, as what goes with the angle does");
}

TEST_F(Earned, AClockThatIsOffIsNotWhereItMayBreakInstead) {
  const auto off = [&](const char* cause, std::vector<std::size_t> members) {
    Evidence evidence = evidence_of(cause);
    evidence.members = std::move(members);
    return doubt(evidence);
  };
  EXPECT_EQ(off("reference_clock_drift", {0, 1}), "");
  instead_.suspects = {&noise_.recordings[1]};
  EXPECT_EQ(off("reference_clock_drift", {0, 1}), "the clock of r1 may break instead");
  EXPECT_EQ(off("reference_clock_drift", {0}), "");
  EXPECT_EQ(off("scale_factor_error", {0, 1}), "") << "no fault of a clock declares it a rival";
}

TEST_F(Earned, ALevelThatAProfileSurpassesIsNot) {
  Evidence level = evidence_of("white_noise_level");
  level.heldout = true;
  level.heldout_gain = 40.0;
  UnnamedFinding profile;
  profile.effect.kind = UnnamedKind::Variance;
  profile.effect.column = "gz";
  profile.effect.kind = UnnamedKind::Variance;
  profile.heldout_gain = 48.0;
  instead_.instead = {profile};
  EXPECT_EQ(doubt(level), "") << "no more than by chance";
  instead_.instead[0].heldout_gain = 50.0;
  EXPECT_EQ(doubt(level), "noise that goes with a quantity predicts the recordings better");
  Evidence with_rate = level;
  with_rate.cause = find_cause("rate_dependent_noise");
  EXPECT_EQ(doubt(with_rate), "") << "it goes with a quantity itself";
  instead_.instead[0].effect.column = "gx";
  EXPECT_EQ(doubt(level), "") << "another channel's";
}

TEST_F(Earned, MeanEffectsThatAProfileOfTheMeanPredictsMoreThanAreNot) {
  const auto beside = [&](UnnamedKind kind, double gain) {
    std::vector<Evidence> found(2, evidence_of("temperature_bias"));
    found[1].cause = find_cause("scale_factor_error");
    for (Evidence& evidence : found) {
      evidence.heldout = true;
      evidence.heldout_gain = 20.0;
    }
    UnnamedFinding profile;
    profile.effect.column = "gz";
    profile.effect.kind = kind;
    profile.heldout_gain = gain;
    instead_.instead = {profile};
    doubt_what_is_not_earned(groups_, {means_}, remains_, instead_, report_, found);
    EXPECT_EQ(found[0].doubt, found[1].doubt);
    return found[0].doubt;
  };
  EXPECT_EQ(beside(UnnamedKind::Mean, 50.0),
            "a mean that goes with a quantity in another way predicts the recordings better");
  EXPECT_EQ(beside(UnnamedKind::Mean, 48.0), "") << "no more than by chance";
  EXPECT_EQ(beside(UnnamedKind::Mean, 30.0), "") << "more than each, less than both";
  EXPECT_EQ(beside(UnnamedKind::Variance, 50.0), "") << "of another kind";
}

TEST_F(Earned, ALevelOfTheRecordingsThatTurnOneWayIsNot) {
  const auto turning = [&](std::size_t r, double turns) {
    StudyRecording& recording = noise_.recordings[r];
    std::vector<double> angle(recording.length);
    for (std::size_t i = 0; i < recording.length; ++i) {
      angle[i] = 2.0 * std::numbers::pi * turns * static_cast<double>(i) / static_cast<double>(recording.length - 1);
    }
    recording.angle = std::move(angle);
  };
  const auto level = [&](std::vector<std::size_t> members) {
    Evidence evidence = evidence_of("white_noise_level");
    evidence.members = std::move(members);
    return doubt(evidence);
  };
  const std::string one_way = "it is that of the recordings that turn one way";
  turning(1, 5.0);
  turning(2, 3.0);
  EXPECT_EQ(level({1, 2}), "") << "no recording turns the other way";
  turning(3, -5.0);
  EXPECT_EQ(level({1, 2}), one_way);
  EXPECT_EQ(level({1}), "") << "one recording may be louder by itself";
  EXPECT_EQ(level({0, 1, 2}), "") << "it is louder at rest too";
  EXPECT_EQ(level({1, 2, 3}), "") << "it is louder both ways";
  turning(4, 5.0);
  EXPECT_EQ(level({1, 2}), "") << "one that turns this way is not louder";
}

TEST_F(Earned, SlowNoiseOrALevelOfRecordingsWhoseRateChangesAloneIsNot) {
  const auto in = [&](const char* cause, std::vector<std::size_t> members) {
    Evidence evidence = evidence_of(cause);
    evidence.members = std::move(members);
    return doubt(evidence);
  };
  const std::string motion = "only recordings whose rate changes have it, as what goes with the motion does";
  noise_.recordings[1].condition.kind = ConditionKind::Profile;
  noise_.recordings[2].condition.kind = ConditionKind::ConstantAngularAcceleration;
  noise_.recordings[3].condition.kind = ConditionKind::ConstantRate;
  for (const char* const cause : {"gauss_markov", "random_walk", "white_noise_level"}) {
    EXPECT_EQ(in(cause, {1, 2}), motion) << cause;
    EXPECT_EQ(in(cause, {1}), motion) << cause;
    EXPECT_EQ(in(cause, {1, 3}), "") << cause << ": at an even rate too";
    EXPECT_EQ(in(cause, {0, 1}), "") << cause << ": at rest too";
  }
  EXPECT_EQ(in("turn_on_bias", {1, 2}), "") << "a constant does not follow the motion";
  EXPECT_EQ(in("noise_level_change", {1}), "") << "it is told by the time within its recording";
  for (StudyRecording& recording : noise_.recordings) {
    recording.condition.kind = ConditionKind::Profile;
  }
  EXPECT_EQ(in("gauss_markov", {0, 1, 2, 3, 4}), "") << "no recording is without it";
}

TEST_F(Earned, ASlowFindingThatLeavesSecondsCorrelatedIsNot) {
  Check check;
  check.title = "correlation of one-second means";
  check.recording = noise_.recordings[1].id;
  check.channel = "gz";
  check.failed = true;
  check.of_slow_misfit = true;
  check.p_after_adjusted = 0.0009;
  const auto in = [&](const char* cause, const Check& left) {
    Evidence evidence = evidence_of(cause);
    evidence.members = {1};
    report_.checks = {Check{}, left};
    return doubt(evidence);
  };
  const std::string left =
      "with it in the model correlation of one-second means of " + check.recording + " still fails";
  EXPECT_EQ(in("bias_step", check), left);
  EXPECT_EQ(in("random_walk", check), left);
  EXPECT_EQ(in("noise_level_change", check), "") << "it was not found by the means";
  Check other = check;
  other.p_after_adjusted = 0.0011;
  EXPECT_EQ(in("bias_step", other), "");
  other = check;
  other.recording = noise_.recordings[2].id;
  EXPECT_EQ(in("bias_step", other), "") << "a recording of which it is not";
  other = check;
  other.of_slow_misfit = false;
  EXPECT_EQ(in("bias_step", other), "");
}

TEST_F(Earned, WhatIsSmallBesideSomethingOfItsKindThatIsDoubtedIsNot) {
  noise_.recordings[1].condition.kind = ConditionKind::Profile;
  const auto beside = [&](const char* cause, double gain, std::vector<std::size_t> larger) {
    std::vector<Evidence> found{evidence_of(cause), evidence_of("white_noise_level")};
    found[0].members = {0, 1, 2, 3, 4};
    found[0].heldout_gain = gain;
    found[1].members = std::move(larger);
    found[1].heldout_gain = 150.0;
    doubt_what_is_not_earned(groups_, {means_}, remains_, instead_, report_, found);
    return found[0].doubt;
  };
  EXPECT_EQ(beside("acceleration_dependent_noise", 49.0, {1}),
            "a larger finding beside it, white noise of another level than the baseline's, has no certain name");
  EXPECT_EQ(beside("acceleration_dependent_noise", 51.0, {1}), "") << "no remainder of it";
  EXPECT_EQ(beside("acceleration_dependent_noise", 49.0, {0}), "") << "the larger one is certain";
  EXPECT_EQ(beside("turn_on_bias", 49.0, {1}), "") << "of another kind";
}

TEST_F(Earned, WhatLeavesAtLeastThreeChecksAndHalfOfThemFailingIsNot) {
  const Evidence evidence = evidence_of("white_noise_level");
  const auto failing = [&](std::size_t before, std::size_t after) {
    report_.failed_before = before;
    report_.failed_after = after;
    return doubt(evidence);
  };
  EXPECT_EQ(failing(6, 3), "3 checks still fail with it");
  EXPECT_EQ(failing(9, 5), "5 checks still fail with it");
  EXPECT_EQ(failing(7, 3), "") << "most of them are mended";
  EXPECT_EQ(failing(2, 2), "") << "one or two may fail beside a true cause";
}

TEST_F(Earned, WhatLeavesTheNoiseOfItsChannelChangingIsNot) {
  Remainder burst;
  burst.channel = "gz";
  burst.p_study = 0.0009;
  burst.in_time_or_frequency = true;
  const auto beside = [&](const Remainder& remainder) {
    remains_ = {Remainder{}, remainder};
    return doubt(evidence_of("white_noise_level"));
  };
  EXPECT_EQ(beside(burst), "with it in the model the noise of gz still changes");
  Remainder weak = burst;
  weak.p_study = 0.0011;
  EXPECT_EQ(beside(weak), "");
  Remainder elsewhere = burst;
  elsewhere.channel = "gx";
  EXPECT_EQ(beside(elsewhere), "");
  Remainder skewed = burst;
  skewed.in_time_or_frequency = false;
  EXPECT_EQ(beside(skewed), "");
}

TEST_F(Earned, GrossValuesAreDoubtedByNoMoreThanTheyGain) {
  Remainder swelling;
  swelling.id = "r0/gz.line_in_variance";
  swelling.channel = "gz";
  swelling.p_study = 0.0009;
  swelling.in_time_or_frequency = true;
  swelling.observed = 60.0;
  remains_ = {swelling, swelling};
  Evidence outliers = evidence_of("outliers");
  outliers.shape = 5.0;
  outliers.heldout_gain = 121.0;
  EXPECT_EQ(doubt(outliers), "");
  Evidence tails = evidence_of("heavy_tailed_noise");
  tails.heldout_gain = 1000.0;
  EXPECT_NE(doubt(tails), "") << "which noise that changes has";
  outliers.heldout_gain = 119.0;
  EXPECT_EQ(doubt(outliers), "with it in the model the noise of gz still changes");
  remains_[1].id = "r1/gz.tiles";
  EXPECT_EQ(doubt(outliers), "") << "another test's";
  remains_.clear();
  UnnamedFinding profile;
  profile.effect.column = "gz";
  profile.effect.kind = UnnamedKind::Variance;
  profile.effect.value = {0.8, 1.5};
  profile.heldout_gain = 500.0;
  instead_.beside = {profile};
  EXPECT_EQ(doubt(outliers), "") << "4.08 deviations of its loudest noise";
  instead_.beside[0].effect.value = {0.8, 1.6};
  EXPECT_EQ(doubt(outliers), "a profile that has no name predicts the recordings beside it") << "3.95";
}

TEST_F(Earned, AMeanIsDoubtedByWhatAMeanCanShowInAndByItsSize) {
  Remainder change;
  change.channel = "gz";
  change.p_study = 0.0009;
  change.in_time_or_frequency = true;
  const auto beside = [&](double observed, bool of_power_alone) {
    change.observed = observed;
    change.of_power_alone = of_power_alone;
    remains_ = {change};
    Evidence evidence = evidence_of("once_per_revolution");
    evidence.heldout_gain = 90.0;
    return doubt(evidence);
  };
  EXPECT_EQ(beside(31.0, false), "with it in the model the noise of gz still changes");
  EXPECT_EQ(beside(29.0, false), "") << "less than a third of its gain";
  EXPECT_EQ(beside(300.0, true), "") << "noise that swells is no mean";
}

TEST_F(Earned, FactsOfAFileAndFaultsOfARecordingAlwaysAre) {
  report_.failed_before = 10;
  report_.failed_after = 10;
  for (const char* const cause : {"missing_samples", "unit_error"}) {
    EXPECT_EQ(doubt(with(evidence_of(cause), "fraction", 1e9, "s")), "") << cause;
  }
  EXPECT_NE(doubt(evidence_of("linear_drift")), "");
}

TEST_F(Earned, IsAskedOfEachFindingInItsOwnChannel) {
  ChannelGroup other = groups_[0];
  other.column = "gx";
  groups_.push_back(other);
  std::vector<Evidence> found(3, evidence_of("turn_on_bias"));
  found[1].group = 1;
  found[2].group = 1;
  found[2].cause = find_cause("random_walk");
  found[2].ambiguous = true;
  doubt_what_is_not_earned(groups_, {means_, {0.0, 0.0, 1.0, 0.0, 0.0}}, remains_, instead_, report_, found);
  EXPECT_EQ(found[0].doubt, "");
  EXPECT_FALSE(found[0].ambiguous);
  EXPECT_EQ(found[1].doubt, "it is carried by r2 alone");
  EXPECT_TRUE(found[1].ambiguous);
  EXPECT_EQ(found[2].doubt, "");
  EXPECT_TRUE(found[2].ambiguous) << "a rival was near already";
}

TEST(MeansOf, AreThoseOfTheResidualsOfEachRecording) {
  const NoiseAtFullRate noise({{1.0, 2.0, 6.0}, {-4.0, -4.0}});
  EXPECT_EQ(means_of(noise.data), (std::vector<double>{3.0, -4.0}));
}

}  // namespace
}  // namespace driftlab::investigate
