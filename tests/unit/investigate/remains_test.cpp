/// A disturbance that no cause describes has to be told where it is: burst, shift, swelling, lopsided noise and noise
/// that two axes share were looked for by code that no test would have missed, had it said nothing or named another
/// place.
#include "core/investigate/report/remains.hpp"

#include "core/investigate/causes/cause.hpp"
#include "core/process/distributions.hpp"
#include "tests/unit/investigate/noise_at_full_rate.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

namespace driftlab::investigate {
namespace {

using testing::StartsWith;

// 1024 frames of a second of 50 samples each.
constexpr double kDt = 0.02;
constexpr std::size_t kFrame = 50;
constexpr std::size_t kSamples = 1024 * kFrame;

/// White noise of unit variance, each sample through `change`, which is told its time.
std::vector<double> changed(std::uint64_t seed, const std::function<double(double value, double t)>& change) {
  std::vector<double> values = white(kSamples, seed);
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = change(values[i], kDt * static_cast<double>(i));
  }
  return values;
}

/// The departure of one test.
Remainder of_test(const std::vector<Remainder>& remains, const std::string& id) {
  for (const Remainder& remainder : remains) {
    if (remainder.id == id) {
      return remainder;
    }
  }
  ADD_FAILURE() << "no " << id;
  return {};
}

double number_after(const std::string& sentence, const std::string& words) {
  const std::size_t at = sentence.find(words);
  EXPECT_NE(at, std::string::npos) << sentence;
  return at == std::string::npos ? std::nan("") : std::strtod(sentence.c_str() + at + words.size(), nullptr);
}

/// Mean square of the normal scores of what is normal with deviation `sd` for `share` of the time and 1 for the rest,
/// there: the integral of [z(F(sd u))]^2 over a standard normal u.
double score_power(double sd, double share) {
  constexpr double kStep = 1e-3;
  double sum = 0.0;
  for (double u = -8.0; u < 8.0; u += kStep) {
    const double density = std::exp(-0.5 * u * u) / std::sqrt(2.0 * std::numbers::pi);
    const double above = share * normal_tail(u) + (1.0 - share) * normal_tail(sd * u);
    const double z = normal_quantile(std::min(1.0 - 1e-15, std::max(1e-15, above)));
    sum += z * z * density * kStep;
  }
  return sum;
}

/// In a quarter of the time the noise is louder, or quieter. A tile of m ordinates of mean power r shows
/// x = m (r - 1 - ln r) / (1 - share), and the most surprising is that very quarter at all frequencies.
TEST(Remains, TellWhenTheNoiseIsLouderOrQuieterAndHowMuch) {
  constexpr double kShare = 0.25;
  constexpr auto kOfAFrame = kFrame / 2 - 1;
  constexpr double kOrdinates = 256.0 * static_cast<double>(kOfAFrame);
  for (const double sd : {2.0, 0.5}) {
    const NoiseAtFullRate noise({white(kSamples, 1), changed(2, [&](double value, double t) {
                                   return t >= 256.0 && t < 512.0 ? sd * value : value;
                                 })});
    const std::vector<Remainder> remains = remains_of_channel(noise.group, noise.data);
    const Remainder tiles = of_test(remains, "r1/gz.tiles");
    EXPECT_EQ(tiles.recording, "r1");
    EXPECT_EQ(tiles.channel, "gz");
    EXPECT_TRUE(tiles.in_time_or_frequency);
    EXPECT_THAT(tiles.sentence, StartsWith("r1/gz: from 256 to 512 s the noise between 1 and 24 Hz has "));
    // Ranks are those of both recordings: of all samples an eighth. Powers are told over their mean in r1.
    const double loud = score_power(sd, 0.5 * kShare);
    const double rest = score_power(1.0 / sd, 1.0 - 0.5 * kShare);
    const double r = loud / (kShare * loud + (1.0 - kShare) * rest);
    const double deviation = r / std::sqrt(kOrdinates);
    EXPECT_NEAR(number_after(tiles.sentence, "Hz has "), r, 5.0 * deviation + 0.005);
    EXPECT_NEAR(tiles.observed, kOrdinates * (r - 1.0 - std::log(r)) / (1.0 - kShare),
                5.0 * kOrdinates * std::fabs(1.0 - 1.0 / r) * deviation / (1.0 - kShare));
    EXPECT_LT(of_test(remains, "r0/gz.tiles").observed, 15.0) << "of the recording in which nothing changes";
  }
}

/// A tone of 11 Hz that is there for an eighth of the time is told by its time and by its band, the narrowest: 3 of the
/// 24 ordinates.
TEST(Remains, TellInWhichBandABurstIs) {
  constexpr double kAmplitude = 0.4;
  const NoiseAtFullRate noise({changed(3, [](double value, double t) {
    return value + (t >= 384.0 && t < 512.0 ? kAmplitude * std::sin(2.0 * std::numbers::pi * 11.0 * t) : 0.0);
  })});
  const Remainder tiles = of_test(remains_of_channel(noise.group, noise.data), "r0/gz.tiles");
  EXPECT_THAT(tiles.sentence, StartsWith("r0/gz: from 384 to 512 s the noise between 10 and 12 Hz has "));
  // The power of a sinusoid of amplitude a in a frame of m samples is a^2 m/4 times that of the noise, s. Of the
  // ordinate that holds it, in units of its mean over the recording, (1 + s)/(1 + s/8), with variance (1 + 2 s)/(1 +
  // s/8)^2.
  constexpr double kTone = kAmplitude * kAmplitude * kFrame / 4.0;
  constexpr double kMean = 1.0 + kTone / 8.0;
  const double deviation = std::sqrt((2.0 + (1.0 + 2.0 * kTone) / kMean / kMean) / 128.0) / 3.0;
  EXPECT_NEAR(number_after(tiles.sentence, "Hz has "), (2.0 + (1.0 + kTone) / kMean) / 3.0, 5.0 * deviation);
}

/// For a quarter of the time the mean is off by d. Less the mean of the whole it is off by 3/4 d there, and with n
/// samples x = n m^2 / 2 / (1 - 1/4).
TEST(Remains, TellWhenTheMeanIsOffAndToWhichSide) {
  constexpr double kQuarter = 0.25 * static_cast<double>(kSamples);
  for (const double shift : {0.1, -0.1}) {
    const NoiseAtFullRate noise(
        {changed(4, [&](double value, double t) { return t < 256.0 ? value + shift : value; })});
    const std::vector<Remainder> remains = remains_of_channel(noise.group, noise.data);
    const Remainder mean = of_test(remains, "r0/gz.mean_over_time");
    EXPECT_FALSE(mean.in_time_or_frequency) << "a cause of the mean is named for what it takes away";
    EXPECT_THAT(mean.sentence, StartsWith("r0/gz: from 0 to 256 s the mean is off by "));
    const double off = 0.75 * shift;
    const double deviation = std::sqrt(0.75 / kQuarter);
    EXPECT_NEAR(number_after(mean.sentence, "off by "), off, 5.0 * deviation);
    EXPECT_NEAR(mean.observed, 0.5 * kQuarter * off * off / 0.75, 5.0 * kQuarter * std::fabs(off) * deviation / 0.75);
  }
}

/// A deviation of 1 + m cos(2 pi f t) gives the square of the scores a line of amplitude 2 m over white noise of
/// variance 2: x = (2 m)^2 n / 4 / 2. With n samples at dt, f is k cycles in n dt; fewer than eight cycles are steps
/// and drifts.
TEST(Remains, TellHowOftenTheNoiseSwells) {
  constexpr double kDepth = 0.1;
  const double expected = 0.5 * kDepth * kDepth * static_cast<double>(kSamples);
  const auto swelling = [](double cycles) {
    const double f = cycles / (kDt * static_cast<double>(kSamples));
    return changed(
        5, [f](double value, double t) { return value * (1.0 + kDepth * std::cos(2.0 * std::numbers::pi * f * t)); });
  };
  NoiseAtFullRate noise({swelling(256.0)});
  const auto line = [&] { return of_test(remains_of_channel(noise.group, noise.data), "r0/gz.line_in_variance"); };
  EXPECT_EQ(line().sentence, "r0/gz: the noise swells and fades at 0.25 Hz");
  EXPECT_TRUE(line().in_time_or_frequency);
  EXPECT_NEAR(line().observed, expected, 5.0 * std::sqrt(2.0 * expected));
  // Where 8 of every 32 s are not in use three quarters of the line are seen, and no line of the pattern itself.
  for (std::size_t i = 0; i < kSamples; ++i) {
    noise.data.used[0][i] = i / kFrame % 32 < 8 ? 0 : 1;
  }
  EXPECT_EQ(line().sentence, "r0/gz: the noise swells and fades at 0.25 Hz");
  EXPECT_NEAR(line().observed, 0.75 * expected, 5.0 * std::sqrt(2.0 * 0.75 * expected));
  const NoiseAtFullRate slow({swelling(4.0)});
  EXPECT_LT(of_test(remains_of_channel(slow.group, slow.data), "r0/gz.line_in_variance").observed, 20.0);
}

/// z sqrt(1 - a^2) + a (w^2 - 1)/sqrt(2) has unit variance and skewness a^3 sqrt(8): errors to one side are larger.
TEST(Remains, TellToWhichSideErrorsAreLarger) {
  constexpr double kShare = 0.3;
  const double skew = kShare * kShare * kShare * std::sqrt(8.0);
  const double deviation = std::sqrt(6.0 / static_cast<double>(kSamples));
  for (const double side : {1.0, -1.0}) {
    const std::vector<double> other = white(kSamples, 7, 1);
    std::vector<double> values = white(kSamples, 7);
    for (std::size_t i = 0; i < values.size(); ++i) {
      values[i] = std::sqrt(1.0 - kShare * kShare) * values[i] +
                  side * kShare * (other[i] * other[i] - 1.0) / std::numbers::sqrt2;
    }
    const NoiseAtFullRate noise({values});
    const Remainder remainder = of_test(remains_of_channel(noise.group, noise.data), "gz.skewness");
    EXPECT_EQ(remainder.recording, "") << "of all recordings of the channel";
    EXPECT_THAT(remainder.sentence, StartsWith("gz: errors to one side are larger than to the other"));
    EXPECT_NEAR(number_after(remainder.sentence, "skewness "), side * skew, 5.0 * 1.2 * deviation);
    const double z = skew / deviation;
    EXPECT_NEAR(remainder.observed, 0.5 * z * z, 5.0 * 1.2 * z);
  }
}

/// Two axes of one recording.
struct TwoAxes {
  NoiseAtFullRate first, second;
  std::vector<ChannelGroup> groups;
  std::vector<GroupOutcome> outcomes;

  TwoAxes(const std::vector<double>& x, const std::vector<double>& z) : first({x}), second({z}) {
    first.group.column = "gx";
    groups = {first.group, second.group};
    outcomes.resize(2);
    for (GroupOutcome& outcome : outcomes) {
      outcome.usable = true;
    }
    outcomes[0].after = first.data;
    outcomes[1].after = second.data;
  }
  [[nodiscard]] std::vector<Remainder> remains(const std::vector<Evidence>& found) const {
    return what_remains(groups, outcomes, found, remains_of_channel(groups[1], outcomes[1].after));
  }
};

/// A share c of amplitude that two axes have in common: coherence c^2, x = m c^2 over the m ordinates of all bands.
TEST(Remains, TellHowMuchTwoAxesShareUnlessItIsKnown) {
  constexpr double kCorrelation = 0.1;
  const std::vector<double> common = white(kSamples, 8, 2);
  const auto axis = [&](std::uint64_t stream) {
    std::vector<double> values = white(kSamples, 8, stream);
    for (std::size_t i = 0; i < values.size(); ++i) {
      values[i] = std::sqrt(1.0 - kCorrelation) * values[i] + std::sqrt(kCorrelation) * common[i];
    }
    return values;
  };
  TwoAxes axes(axis(0), axis(1));
  const std::vector<Remainder> remains = axes.remains({});
  const Remainder& shared = remains.front();
  EXPECT_EQ(shared.id, "r0/gx.gz.coherence");
  EXPECT_EQ(shared.channel, "gx");
  EXPECT_EQ(shared.recording, "r0");
  EXPECT_THAT(shared.sentence, StartsWith("gx and gz of r0: the two share "));
  EXPECT_NEAR(number_after(shared.sentence, "share "), 100.0 * kCorrelation, 100.0 * 5.0 / std::sqrt(kSamples));
  const double expected = 0.5 * static_cast<double>(kSamples) * kCorrelation * kCorrelation;
  EXPECT_NEAR(shared.observed, expected, 5.0 * std::sqrt(2.0 * expected));
  EXPECT_DOUBLE_EQ(shared.p_study, static_cast<double>(remains.size()) * shared.places * std::exp(-shared.observed));
  EXPECT_GT(remains[1].p_study, kShown) << "nothing but the common part: " << remains[1].sentence;

  Evidence known;
  known.cause = find_cause("common_mode_noise");
  known.also_groups = {1};
  known.shape = kCorrelation;
  EXPECT_GT(axes.remains({known}).front().p_study, kShown);
  known.also_groups = {};
  EXPECT_LT(axes.remains({known}).front().p_study, kShown) << "of one axis alone it explains nothing between two";
  axes.outcomes[0].usable = false;
  EXPECT_GT(axes.remains({}).front().p_study, kShown) << "an axis that could not be examined is in no pair";
}

/// Of white noise nothing is told: thirty channels at a level of 0.003 each.
TEST(Remains, AreNothingWhereTheModelIsRight) {
  int told = 0;
  for (std::uint64_t seed = 100; seed < 130; ++seed) {
    const NoiseAtFullRate noise({white(6400, seed, 0), white(6400, seed, 1)});
    const std::vector<Remainder> remains = what_remains({}, {}, {}, remains_of_channel(noise.group, noise.data));
    EXPECT_EQ(remains.size(), 11U);
    told += remains.front().p_study < kShown ? 1 : 0;
  }
  EXPECT_LE(told, 1);
}

/// Differenced uniform noise is not independent, and known not to be.
TEST(Remains, AskForNoDependenceBesideQuantizationNoise) {
  NoiseAtFullRate noise({white(6400, 10)});
  const auto asked = [&] {
    const std::vector<Remainder> remains = remains_of_channel(noise.group, noise.data);
    return std::any_of(remains.begin(), remains.end(),
                       [](const Remainder& remainder) { return remainder.id == "r0/gz.dependence"; });
  };
  EXPECT_TRUE(asked());
  noise.data.quantization = 1e-6;
  EXPECT_FALSE(asked());
}

TEST(Remains, OfTooFewSamplesAreNotLookedFor) {
  const NoiseAtFullRate noise({white(499, 9)});
  const std::vector<Remainder> remains = remains_of_channel(noise.group, noise.data);
  ASSERT_EQ(remains.size(), 1U);
  EXPECT_EQ(remains[0].id, "gz.skewness");
  EXPECT_EQ(remains[0].observed, 0.0);
}

Remainder departure(const std::string& channel, double observed, double places, double p_study) {
  Remainder remainder;
  remainder.id = "r3/" + channel + ".tiles";
  remainder.recording = "r3";
  remainder.channel = channel;
  remainder.observed = observed;
  remainder.places = places;
  remainder.p_study = p_study;
  remainder.sentence = "r3/" + channel + ": it hums";
  return remainder;
}

/// The largest of k unit exponentials lies below q with probability (1 - e^-q)^k, to first order exp(-k e^-q).
TEST(Remains, AreReportedAsChecksThatFailBeforeAndAfter) {
  Report report;
  report.failed_before = 2;
  report.failed_after = 1;
  report_remains({departure("gy", 20.0, 100.0, 1e-6), departure("gy", 9.0, 100.0, 0.004)}, report);
  ASSERT_EQ(report.checks.size(), 1U);
  const Check& check = report.checks[0];
  EXPECT_EQ(check.id, "r3/gy.tiles");
  EXPECT_EQ(check.recording, "r3");
  EXPECT_EQ(check.channel, "gy");
  EXPECT_EQ(check.observed, 20.0);
  EXPECT_EQ(check.observed_after, 20.0);
  EXPECT_NEAR(std::exp(-100.0 * std::exp(-check.q025)), 0.025, 1e-12);
  EXPECT_NEAR(std::exp(-100.0 * std::exp(-check.median)), 0.5, 1e-12);
  EXPECT_NEAR(std::exp(-100.0 * std::exp(-check.q975)), 0.975, 1e-12);
  EXPECT_DOUBLE_EQ(check.p, 100.0 * std::exp(-20.0));
  EXPECT_DOUBLE_EQ(check.p_after, check.p);
  EXPECT_EQ(check.p_adjusted, 1e-6);
  EXPECT_EQ(check.p_after_adjusted, 1e-6);
  EXPECT_TRUE(check.failed && check.failed_after);
  EXPECT_EQ(check.end, CheckEnd::Unexplained);
  EXPECT_EQ(report.failed_before, 3U);
  EXPECT_EQ(report.failed_after, 2U);
  ASSERT_EQ(report.unexplained.size(), 1U);
  EXPECT_EQ(report.unexplained[0].channel, "gy");
  EXPECT_EQ(report.unexplained[0].sentence, "r3/gy: it hums. No cause of the list explains it.");
  EXPECT_EQ(report.unexplained[0].checks, std::vector<std::string>{"r3/gy.tiles"});
}

TEST(Remains, AreReportedThreeTimesAChannelAtMost) {
  Report report;
  std::vector<Remainder> many(5, departure("gx", 30.0, 10.0, 1e-9));
  many.push_back(departure("gz", 25.0, 10.0, 1e-7));
  report_remains(many, report);
  ASSERT_EQ(report.checks.size(), 4U);
  EXPECT_EQ(report.checks[2].channel, "gx");
  EXPECT_EQ(report.checks[3].channel, "gz");
  EXPECT_EQ(report.unexplained.size(), 4U);
  EXPECT_EQ(report.failed_after, 4U);
}

/// Noise that changes in time is not independent from sample to sample either: the change says it all.
TEST(Remains, OfDependenceAreNotReportedBesideAChangeInTime) {
  Remainder follower = departure("gx", 40.0, 10.0, 1e-12);
  follower.id = "r3/gx.dependence";
  follower.follows_changes = true;
  Remainder change = departure("gx", 30.0, 10.0, 1e-9);
  change.in_time_or_frequency = true;
  const auto reported = [&](const Remainder& beside) {
    Report report;
    report_remains({follower, beside}, report);
    return std::any_of(report.checks.begin(), report.checks.end(),
                       [&](const Check& check) { return check.id == follower.id; });
  };
  EXPECT_FALSE(reported(change));
  Remainder elsewhere = change;
  elsewhere.channel = "gz";
  EXPECT_TRUE(reported(elsewhere)) << "of another channel";
  Remainder chance = change;
  chance.p_study = 0.01;
  EXPECT_TRUE(reported(chance)) << "it is none";
  Remainder mean = change;
  mean.in_time_or_frequency = false;
  EXPECT_TRUE(reported(mean)) << "of the mean";
}

}  // namespace
}  // namespace driftlab::investigate
