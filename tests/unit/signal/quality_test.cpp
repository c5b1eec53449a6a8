/// What the quality of a recording says about each quirk that real recordings have, and which samples analysis then
/// takes.
#include "core/signal/missing.hpp"
#include "core/signal/recording_view.hpp"

#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <random>

namespace driftlab {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

using Table = std::vector<std::vector<double>>;

std::vector<double> noise(std::size_t count, std::uint64_t seed = 7) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal(0.0, 0.1);
  std::vector<double> values(count);
  for (double& value : values) {
    value = normal(random);
  }
  return values;
}

std::vector<double> clock(std::size_t count, double step = 0.01) {
  std::vector<double> stamps(count);
  for (std::size_t i = 0; i < count; ++i) {
    stamps[i] = step * static_cast<double>(i);
  }
  return stamps;
}

Result<RecordingView> view(const Table& table, const ColumnNames& names, std::optional<double> rate_hz = 100.0) {
  RecordingSpec spec;
  spec.rate_hz = rate_hz;
  return view_recording(spec, names, table.front().size(),
                        [&](std::size_t i) { return std::span<const double>(table[i]); });
}

/// The quality of one gyroscope column.
ChannelQuality quality_of(const std::vector<double>& values) {
  const auto seen = view({values}, {"gz [deg/s]"});
  EXPECT_TRUE(seen) << seen.error().message;
  return seen ? seen->window.quality.channels.at(0) : ChannelQuality{};
}

std::string fault(const std::vector<double>& values) {
  const auto seen = view({values}, {"gz"});
  if (seen) {
    return "accepted";
  }
  return std::string(name_of(seen.error().code)) + "@" + seen.error().fields.at(0).value + ":" +
         seen.error().fields.at(1).value;
}

TEST(Quality, IsSilentAboutASoundChannel) {
  const auto seen = view({noise(5000)}, {"gz [deg/s]"});
  ASSERT_TRUE(seen);
  const ChannelQuality& channel = seen->window.quality.channels.at(0);
  EXPECT_EQ(channel.missing + channel.implausible + channel.saturated + channel.frozen + channel.repeated, 0U);
  EXPECT_FALSE(channel.distinct);
  EXPECT_EQ(channel.resolution, 0.0);
  EXPECT_EQ(channel.first, 1U);
  EXPECT_EQ(channel.analysed, 5000U);
  EXPECT_TRUE(seen->window.quality.notes.empty()) << seen->window.quality.notes.front();
}

TEST(Quality, CountsMissingSamplesAndTakesTheOthers) {
  std::vector<double> values = noise(5000);
  values[1000] = missing_sample(Missing::Empty, 1002);
  values[1001] = missing_sample(Missing::Nan, 1003);
  values[4000] = missing_sample(Missing::Nan, 4002);
  const auto seen = view({values}, {"gz"});
  ASSERT_TRUE(seen) << seen.error().message;
  const ChannelView& view = seen->channels[0];
  EXPECT_EQ(view.values.size(), 4997U);
  EXPECT_EQ(view.values[1000], values[1002]);
  EXPECT_THAT(view.gaps, ElementsAre(Gap{1000, 2}, Gap{3998, 1}));
  EXPECT_THAT(view.stretch.runs, ElementsAre(RowRun{0, 1000, 0}, RowRun{1002, 2998, 2}, RowRun{4001, 999, 1}));
  EXPECT_EQ(view.rows(1500, 10).data(), view.values.data() + 1498);
  const ChannelQuality& channel = seen->window.quality.channels.at(0);
  EXPECT_EQ(channel.missing, 3U);
  EXPECT_EQ(channel.first, 1U);
  EXPECT_EQ(channel.last, 5000U);
  EXPECT_EQ(channel.analysed, 4997U);
  EXPECT_THAT(seen->window.quality.notes, Contains(AllOf(HasSubstr("3 samples are missing"),
                                                         HasSubstr("4997 of the samples 1 to 5000 are analysed"))));
}

TEST(Quality, RefusesAChannelOfWhichTooMuchIsMissingByItsFirstRow) {
  std::vector<double> values = noise(3000);
  values[10] = missing_sample(Missing::Text, 12);
  EXPECT_EQ(fault(values), "not_a_number@12:gz");
  values[10] = missing_sample(Missing::Infinite, 12);
  EXPECT_EQ(fault(values), "non_finite@12:gz");
  values[10] = missing_sample(Missing::OutOfRange, 12);
  EXPECT_EQ(fault(values), "out_of_range@12:gz");
  values[10] = std::numeric_limits<double>::infinity();
  EXPECT_EQ(fault(values), "non_finite@11:gz");
  // NaN in two of 3000 is reported; one in a thousand is refused.
  values[10] = missing_sample(Missing::Nan, 12);
  values[11] = missing_sample(Missing::Nan, 13);
  EXPECT_EQ(fault(values), "accepted");
  values[12] = std::nan("");
  EXPECT_EQ(fault(values), "non_finite@12:gz");
  // Empty cells: up to 5 %.
  values = noise(3000);
  for (std::size_t i = 0; i < 150; ++i) {
    values[20 * i] = missing_sample(Missing::Empty, 20 * i + 2);
  }
  EXPECT_EQ(fault(values), "accepted");
  values[1] = missing_sample(Missing::Empty, 3);
  EXPECT_EQ(fault(values), "not_a_number@2:gz");
}

TEST(Quality, LeavesOutAColumnOfUnknownMeaningThatHoldsText) {
  std::vector<double> words(3000, missing_sample(Missing::Text, 2));
  const auto seen = view({words, noise(3000)}, {"state", "signal"});
  ASSERT_TRUE(seen) << seen.error().message;
  EXPECT_EQ(seen->channels.size(), 1U);
  EXPECT_THAT(seen->window.quality.notes, Contains(HasSubstr("'state' is left out")));
}

TEST(Quality, SkipsByNameWhatStandsBesideInertialSensors) {
  // Quaternions, a pressure and `Zeit [s]` beside a gyroscope were characterised as sensors in unit 1.
  const Table table{noise(3000), noise(3000, 8), noise(3000, 9)};
  const auto seen = view(table, {"q_w", "gz [deg/s]", "pressure"});
  ASSERT_TRUE(seen) << seen.error().message;
  ASSERT_EQ(seen->channels.size(), 1U);
  EXPECT_EQ(seen->channels[0].column, "gz [deg/s]");
  EXPECT_THAT(seen->window.quality.notes, Contains(HasSubstr("skipped: 'q_w', 'pressure'.")));
  // What speaks of an inertial sensor is not dropped because its axis is unclear.
  EXPECT_EQ(view({table[0], table[1]}, {"gz", "acc_l"})->channels.size(), 2U);
  // Alone they are all there is to analyse; stated, they are what the user wants.
  EXPECT_EQ(view({table[0]}, {"pressure"})->channels.size(), 1U);
  RecordingSpec spec;
  spec.rate_hz = 100.0;
  spec.columns = {{"q_w", {}}, {"gz [deg/s]", {Quantity::AngularRate, "z", *parse_unit("deg/s")}}};
  const auto stated = view_recording(spec, {"q_w", "gz [deg/s]"}, 3000,
                                     [&](std::size_t i) { return std::span<const double>(table[i]); });
  ASSERT_TRUE(stated) << stated.error().message;
  EXPECT_EQ(stated->channels.size(), 2U);
}

TEST(Quality, TakesNumbersThatMeanNothingAsMissing) {
  std::vector<double> values = noise(6000);
  values[100] = -9999.0;
  values[200] = -1.7e38;
  values[300] = -9999.0;
  const ChannelQuality channel = quality_of(values);
  EXPECT_EQ(channel.implausible, 3U);
  EXPECT_EQ(channel.first, 1U);
  EXPECT_EQ(channel.analysed, 5997U);
  // In a channel of counts they are measurements.
  std::vector<double> counts = noise(6000);
  for (double& count : counts) {
    count = std::round(count * 1e5);
  }
  counts[100] = -9999.0;
  EXPECT_EQ(quality_of(counts).implausible, 0U);
}

TEST(Quality, SeesASensorThatFreezes) {
  std::vector<double> values = noise(6000);
  std::fill(values.begin() + 4000, values.end(), values[4000]);
  const ChannelQuality channel = quality_of(values);
  EXPECT_EQ(channel.frozen, 2000U);
  EXPECT_EQ(channel.frozen_from, 4001U);
  EXPECT_EQ(channel.first, 1U);
  EXPECT_EQ(channel.analysed, 4000U);
}

TEST(Quality, LeavesOutASensorThatIsFrozenThroughoutTheWindow) {
  std::vector<double> stamps = clock(6000);
  for (std::size_t i = 1000; i < stamps.size(); ++i) {
    stamps[i] += 30.0;  // more than a fifth of the recording
  }
  std::vector<double> values = noise(6000);
  std::fill(values.begin() + 900, values.end(), values[900]);
  const auto seen = view({stamps, values, noise(6000, 8)}, {"time (s)", "gx", "gy"}, std::nullopt);
  ASSERT_TRUE(seen) << seen.error().message;
  ASSERT_EQ(seen->channels.size(), 1U);
  EXPECT_EQ(seen->channels[0].column, "gy");
  EXPECT_EQ(seen->window.quality.channels.at(0).frozen, 5100U);
  EXPECT_EQ(seen->window.quality.channels.at(0).analysed, 0U);
  EXPECT_THAT(seen->window.quality.notes, Contains(HasSubstr("It is left out.")));
}

TEST(Quality, ASensorThatHasEndedIsNotFrozen) {
  // Its last sample was taken for a stretch of one value, as long as what is missing behind it, and left out.
  std::vector<double> values = noise(6000, 3);
  for (std::size_t i = 4000; i < values.size(); ++i) {
    values[i] = missing_sample(Missing::Ended, i + 1);
  }
  const ChannelSurvey survey = survey_channel("gz", values);
  EXPECT_EQ(survey.quality.frozen, 0U);
  EXPECT_EQ(survey.quality.missing, 2000U);
  std::fill(values.begin() + 3000, values.begin() + 4000, 0.25);
  values[3500] = missing_sample(Missing::Empty, 3501);
  const ChannelSurvey stuck = survey_channel("gz", values);
  EXPECT_EQ(stuck.frozen, (std::pair<std::size_t, std::size_t>{3000, 4000})) << "a hole within does not end it";
}

TEST(Quality, DoesNotTakeCoarseStepsForAFrozenSensor) {
  // Noise of half a step: three values, runs of up to some tens of samples.
  std::vector<double> values = noise(50000);
  for (double& value : values) {
    value = 0.2 * std::round(value / 0.2);
  }
  const ChannelQuality channel = quality_of(values);
  EXPECT_EQ(channel.frozen, 0U);
  EXPECT_EQ(channel.saturated, 0U);
  ASSERT_TRUE(channel.distinct);
  EXPECT_THAT(*channel.distinct, ::testing::AllOf(::testing::Ge(3U), ::testing::Le(7U)));
  EXPECT_NEAR(channel.resolution, 0.2, 1e-12);
  EXPECT_GT(channel.repeated, 20000U);
}

TEST(Quality, CountsSamplesAtFullScale) {
  std::vector<double> values = noise(6000);
  for (double& value : values) {
    value = std::clamp(std::round(value / 0.01) * 0.01, -0.1, 0.1);  // 17 % at each end
  }
  const ChannelQuality clipped = quality_of(values);
  EXPECT_GT(clipped.saturated, 1500U);
  std::vector<double> counts(6000);
  for (std::size_t i = 0; i < counts.size(); ++i) {
    counts[i] = std::round(noise(1, i)[0] * 1000.0);
  }
  counts[50] = -32768.0;
  counts[51] = 32767.0;
  EXPECT_EQ(quality_of(counts).saturated, 2U);
}

TEST(Quality, SplitsWhereTheClockIsSetBack) {
  std::vector<double> stamps = clock(4000);
  for (std::size_t i = 2500; i < stamps.size(); ++i) {
    stamps[i] -= 1.0;
  }
  const auto seen = view({stamps, noise(4000)}, {"time (s)", "gz"}, std::nullopt);
  ASSERT_TRUE(seen) << seen.error().message;
  EXPECT_EQ(seen->window.quality.backward_steps, 1U);
  EXPECT_EQ(seen->window.count, 2500U);
  EXPECT_NEAR(seen->window.time.dt_s, 0.01, 1e-12);
  EXPECT_NEAR(seen->window.quality.measured_rate_hz, 100.0, 0.1);
  EXPECT_THAT(
      seen->window.quality.notes,
      Contains("The time column steps back once, by 0.99 s, before sample 2501; the recording is split there and "
               "its longest part analysed, samples 1 to 2500; the other 1500 are left out."));
  EXPECT_THAT(seen->window.quality.notes, Not(Contains(HasSubstr("Too much is missing")))) << "nothing is";
}

TEST(Quality, NamesThePartBetweenTwoRestartsOfTheClockAndWhatIsMissingInIt) {
  std::vector<double> stamps = clock(6000);
  for (std::size_t i = 1000; i < stamps.size(); ++i) {
    stamps[i] -= i < 5000 ? 10.0 : 30.0;
  }
  const auto seen = view({stamps, noise(6000)}, {"time (s)", "gz"}, std::nullopt);
  ASSERT_TRUE(seen) << seen.error().message;
  EXPECT_EQ(seen->window.first, 1000U);
  EXPECT_EQ(seen->window.count, 4000U);
  EXPECT_THAT(seen->window.quality.notes,
              Contains(HasSubstr("; the recording is split there and its longest part analysed, samples 1001 to 5000; "
                                 "the other 2000 are left out.")));
  // A gap of half an hour in the longest part is more than is bridged: said of the part, not of the file.
  for (std::size_t i = 4000; i < 5000; ++i) {
    stamps[i] += 1800.0;
  }
  const auto torn = view({stamps, noise(6000)}, {"time (s)", "gz"}, std::nullopt);
  ASSERT_TRUE(torn) << torn.error().message;
  EXPECT_THAT(torn->window.quality.notes, Contains(HasSubstr("3000 of 4000 samples are analysed, from sample 1001.")));
}

TEST(Quality, RefusesAClockThatStepsBackOnceInAThousandRows) {
  std::vector<double> stamps = clock(1000);
  std::swap(stamps[500], stamps[501]);
  const auto seen = view({stamps, noise(1000)}, {"time (s)", "gz"}, std::nullopt);
  ASSERT_FALSE(seen);
  EXPECT_EQ(seen.error().code, ErrorCode::NonMonotonicTime);
  EXPECT_EQ(seen.error().fields.at(0).value, "502");
}

TEST(Quality, ContinuesACounterThatStartsAgain) {
  for (const auto& [wrap, step] : {std::pair{65536.0, 10.0}, std::pair{4294967296.0, 10000.0}}) {
    std::vector<double> ticks(4000);
    for (std::size_t i = 0; i < ticks.size(); ++i) {
      ticks[i] = std::fmod(wrap - 1000.0 * step + step * static_cast<double>(i), wrap);
    }
    const auto seen = view({ticks, noise(4000)}, {"time (us)", "gz"}, std::nullopt);
    ASSERT_TRUE(seen) << seen.error().message;
    EXPECT_EQ(seen->window.quality.counter_wraps, 1U);
    EXPECT_EQ(seen->window.quality.backward_steps, 0U);
    EXPECT_EQ(seen->window.count, 4000U);
    EXPECT_NEAR(seen->window.time.dt_s, step * 1e-6, 1e-15);
  }
}

TEST(Quality, ReadsBurstsAsEvenlySpacedSamples) {
  // A FIFO of four is read every 40 ms; its samples are stamped on arrival, 0.5 ms apart. Then a real gap of 2 s.
  std::vector<double> stamps(4000);
  for (std::size_t i = 0; i < stamps.size(); ++i) {
    const std::size_t burst = i / 4;
    stamps[i] = 0.04 * static_cast<double>(burst) + 0.0005 * static_cast<double>(i % 4) + (i >= 3000 ? 2.0 : 0.0);
  }
  const auto seen = view({stamps, noise(4000)}, {"time (s)", "gz"}, std::nullopt);
  ASSERT_TRUE(seen) << seen.error().message;
  EXPECT_TRUE(seen->window.quality.bursts);
  EXPECT_EQ(seen->window.quality.gaps, 1U);
  EXPECT_EQ(seen->window.count, 4000U);
  EXPECT_THAT(seen->window.gaps, ElementsAre(Gap{3000, 200}));
  // 4199 steps from the first sample of the first FIFO to the last of the last: 41.9615 s instead of 41.99 s.
  EXPECT_NEAR(seen->window.time.dt_s, 0.01, 0.01 * 1.1e-3);
  EXPECT_NEAR(seen->window.quality.jitter_s, 0.5 * (0.0385 - 0.0005), 1e-9);
}

TEST(Quality, DoesNotCountARowThatTheLoggerWroteTwice) {
  // One row in twenty is there twice. They counted as samples, and lowered the white noise by what they repeat.
  std::vector<double> stamps;
  std::vector<double> values;
  const std::vector<double> truth = noise(4000);
  for (std::size_t i = 0; i < truth.size(); ++i) {
    for (int copy = 0; copy < (i % 20 == 7 ? 2 : 1); ++copy) {
      stamps.push_back(0.01 * static_cast<double>(i));
      values.push_back(i == 27 ? missing_sample(Missing::Empty, values.size()) : truth[i]);
    }
  }
  const auto seen = view({stamps, values}, {"time (s)", "gz"}, std::nullopt);
  ASSERT_TRUE(seen) << seen.error().message;
  const Quality& quality = seen->window.quality;
  EXPECT_EQ(quality.repeated_rows, 200U);
  EXPECT_EQ(quality.repeated_stamps, 0U);
  EXPECT_EQ(quality.samples, 4000U);
  EXPECT_EQ(seen->channels[0].values.size(), 3999U);
  EXPECT_EQ(seen->channels[0].values[26], truth[26]);
  EXPECT_EQ(seen->channels[0].values[27], truth[28]);
  EXPECT_NEAR(seen->window.time.dt_s, 0.01, 1e-12);
  EXPECT_THAT(quality.notes, Contains(HasSubstr("200 of 4200 rows repeat the row before")));
}

TEST(Quality, CountsEqualSamplesOfACoarseClockOrAFrozenSensor) {
  // Two samples share each stamp; on a lattice of a few values they are often equal.
  std::vector<double> stamps(4000);
  std::vector<double> values = noise(4000);
  for (std::size_t i = 0; i < stamps.size(); ++i) {
    const std::size_t tick = i / 2;
    stamps[i] = 0.02 * static_cast<double>(tick);
    values[i] = 0.1 * std::round(values[i] / 0.1);
  }
  const auto coarse = view({stamps, values}, {"time (s)", "gz"}, std::nullopt);
  ASSERT_TRUE(coarse) << coarse.error().message;
  EXPECT_EQ(coarse->window.quality.repeated_rows, 0U);
  EXPECT_EQ(coarse->window.quality.samples, 4000U);
  const auto frozen = view({stamps, std::vector<double>(4000, 1.0)}, {"time (s)", "gz"}, std::nullopt);
  ASSERT_TRUE(frozen) << frozen.error().message;
  EXPECT_EQ(frozen->window.quality.samples, 4000U);
}

TEST(Quality, ComparesTheClockWithTheStatedRate) {
  const auto seen = view({clock(2000, 0.01005), noise(2000)}, {"time (s)", "gz"}, 100.0);
  ASSERT_TRUE(seen) << seen.error().message;
  ASSERT_TRUE(seen->window.quality.clock_ratio);
  EXPECT_NEAR(*seen->window.quality.clock_ratio, 1.0 / 1.005, 1e-9);
}

TEST(Quality, UsesTheStatedRateWhereTheClockStands) {
  const auto seen = view({std::vector<double>(2000, 1.7e9), noise(2000)}, {"time (s)", "gz"}, 100.0);
  ASSERT_TRUE(seen) << seen.error().message;
  EXPECT_NEAR(seen->window.time.dt_s, 0.01, 1e-15);
  EXPECT_THAT(seen->window.quality.notes, Contains(HasSubstr("never advances")));
}

TEST(Quality, LeavesOutTheErrorWhereTheReferenceIsMissing) {
  std::vector<double> reference(3000, 0.0);
  reference[1000] = missing_sample(Missing::Empty, 1002);
  RecordingSpec spec;
  spec.rate_hz = 100.0;
  spec.columns = {{"gz", {Quantity::AngularRate, "z", *parse_unit("deg/s")}},
                  {"rz", {Quantity::ReferenceAngularRate, "z", *parse_unit("deg/s")}}};
  const Table table{noise(3000), reference};
  const auto seen =
      view_recording(spec, {"gz", "rz"}, 3000, [&](std::size_t i) { return std::span<const double>(table[i]); });
  ASSERT_TRUE(seen) << seen.error().message;
  EXPECT_EQ(seen->channels[0].values.size(), 2999U);
  EXPECT_THAT(seen->channels[0].gaps, ElementsAre(Gap{1000, 1}));
}

TEST(Quality, RampsFromRestThroughAGap) {
  // 2 deg/s^2 from the first row on, read without error; 5 s are lost after 10 s.
  std::vector<double> stamps = clock(6000);
  std::vector<double> rate(6000);
  for (std::size_t i = 0; i < stamps.size(); ++i) {
    stamps[i] += i >= 1000 ? 5.0 : 0.0;
    rate[i] = 2.0 * stamps[i];
  }
  RecordingSpec spec;
  spec.condition = *parse_condition("constant_angular_acceleration:z:2:deg/s^2");
  spec.trim.start_s = 1.0;
  const Table table{stamps, rate};
  const auto seen = view_recording(spec, {"time (s)", "gz (deg/s)"}, 6000,
                                   [&](std::size_t i) { return std::span<const double>(table[i]); });
  ASSERT_TRUE(seen) << seen.error().message;
  const ChannelView& channel = seen->channels[0];
  ASSERT_EQ(channel.values.size(), 5900U);
  EXPECT_THAT(channel.gaps, ElementsAre(Gap{900, 500}));
  for (const std::size_t i : {std::size_t{0}, std::size_t{899}, std::size_t{900}, std::size_t{5899}}) {
    EXPECT_NEAR(channel.values[i], 0.0, 1e-9) << i;
    EXPECT_NEAR(channel.reference[i], rate[i + 100], 1e-9) << i;
  }
}

TEST(Quality, FindsTheRowsThatAllAxesHave) {
  Table table{noise(3000, 1), noise(3000, 2), noise(3000, 3)};
  table[0][500] = missing_sample(Missing::Nan, 502);
  table[1][1700] = missing_sample(Missing::Nan, 1702);
  const auto seen = view(table, {"gx", "gy", "gz"});
  ASSERT_TRUE(seen) << seen.error().message;
  const std::array<const ChannelView*, 3> triad{&seen->channels[0], &seen->channels[1], &seen->channels[2]};
  EXPECT_EQ(longest_shared_run(triad), (std::pair<std::size_t, std::size_t>{1701, 1299}));
  EXPECT_EQ(seen->channels[0].rows(1701, 1299).front(), table[0][1701]);
}

}  // namespace
}  // namespace driftlab
