/// What is wrong with recordings is read off their rows, stamps and motion; what is right is left alone.
#include "core/investigate/consistency/recording_gains.hpp"
#include "core/investigate/consistency/reference_clock.hpp"
#include "core/investigate/facts/copied_blocks.hpp"
#include "core/investigate/facts/resampled.hpp"
#include "core/investigate/search/right_recordings.hpp"
#include "core/investigate/study/lattice.hpp"
#include "core/investigate/study/time_grid.hpp"
#include "core/process/random.hpp"
#include "core/signal/angle.hpp"
#include "core/signal/turns.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <functional>
#include <numbers>
#include <optional>

namespace driftlab::investigate {
namespace {

std::vector<double> rounded_noise(std::size_t samples, double step, std::uint64_t seed) {
  Random random(seed);
  std::vector<double> rows(samples);
  for (double& v : rows) {
    v = step * std::round(random.normal() / step);
  }
  return rows;
}

TEST(CopiedBlocks, AreFoundWhereTheyAreToTheRow) {
  std::vector<double> rows = rounded_noise(20000, 0.05, 1);
  std::copy_n(rows.begin() + 5000, 80, rows.begin() + 5080);
  std::copy_n(rows.begin() + 9000, 150, rows.begin() + 9150);
  const auto blocks = find_copied_blocks({rows});
  ASSERT_EQ(blocks.size(), 2U);
  // A neighbour may be equal by chance.
  EXPECT_NEAR(static_cast<double>(blocks[0].copy), 5080.0, 2.0);
  EXPECT_NEAR(static_cast<double>(blocks[0].length), 80.0, 2.0);
  EXPECT_NEAR(static_cast<double>(blocks[1].copy), 9150.0, 2.0);
  EXPECT_NEAR(static_cast<double>(blocks[1].length), 150.0, 2.0);
}

/// On a lattice of two standard deviations two rows in five are equal by chance, and frozen sensors repeat one value.
TEST(CopiedBlocks, CoarseLatticesAndFrozenSensorsHaveNone) {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    for (const double step : {0.01, 0.4, 1.0, 2.0}) {
      std::vector<double> rows = rounded_noise(15000, step, seed);
      std::fill_n(rows.begin() + 4000, 600, 1.25);
      std::fill_n(rows.begin() + 9000, 600, 1.25);
      EXPECT_TRUE(find_copied_blocks({rows}).empty()) << "step " << step << ", seed " << seed;
    }
  }
}

std::vector<double> interpolated(const std::vector<double>& rows, std::size_t every) {
  std::vector<double> out = rows;
  for (std::size_t i = 0; i < out.size(); ++i) {
    const std::size_t from = i - i % every;
    const double next = from + every < rows.size() ? rows[from + every] : rows[from];
    const double share = static_cast<double>(i % every) / static_cast<double>(every);
    out[i] = 1e-4 * std::round((rows[from] + share * (next - rows[from])) / 1e-4);
  }
  return out;
}

TEST(Resampled, InterpolationIsFoundWithItsPhaseAndNothingElseIs) {
  const std::vector<double> rows = rounded_noise(20000, 1e-4, 3);
  for (const std::size_t every : {2U, 3U, 5U, 10U}) {
    const std::vector<double> made = interpolated(rows, every);
    EXPECT_EQ(find_interpolation(made, 1e-4).every, every);
    EXPECT_EQ(find_interpolation(std::span(made).subspan(1), 1e-4).phase, every - 1);
  }
  EXPECT_EQ(find_interpolation(rows, 1e-4).every, 0U);
  EXPECT_EQ(find_interpolation(rounded_noise(20000, 0.5, 4), 0.5).every, 0U) << "a coarse lattice lies on many chords";
}

TEST(Resampled, RunningMeansAreFoundAndLowPassesAreNot) {
  const std::vector<double> rows = rounded_noise(40000, 1e-6, 5);
  for (const std::size_t m : {2U, 3U, 4U, 7U}) {
    std::vector<double> made(rows.size());
    for (std::size_t i = 0; i < rows.size(); ++i) {
      for (std::size_t k = 0; k < m && k <= i; ++k) {
        made[i] += rows[i - k] / static_cast<double>(m);
      }
    }
    EXPECT_EQ(find_running_mean(made, 1e-6), m);
  }
  std::vector<double> low(rows.size());
  for (std::size_t i = 1; i < rows.size(); ++i) {
    low[i] = 0.6 * low[i - 1] + 0.4 * rows[i];
  }
  EXPECT_EQ(find_running_mean(low, 1e-6), 0U);
  EXPECT_EQ(find_running_mean(rows, 1e-6), 0U);
}

// Its zero at half the rate is that of a mean over two samples, and slow noise leaks into it.
TEST(Resampled, ALowPassOfSecondOrderIsNoRunningMean) {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const std::vector<double> rows = rounded_noise(30000, 1e-6, seed);
    const std::vector<double> steps = rounded_noise(30000, 1e-6, 100 + seed);
    const double corner = 0.2 + 0.01 * static_cast<double>(seed - 1);  // of the rate
    const double w = std::tan(std::numbers::pi * corner);
    const double norm = 1.0 / (1.0 + std::numbers::sqrt2 * w + w * w);
    std::vector<double> low(rows.size());
    double walk = 0.0;
    for (std::size_t i = 2; i < rows.size(); ++i) {
      low[i] = norm * (w * w * (rows[i] + 2.0 * rows[i - 1] + rows[i - 2]) - 2.0 * (w * w - 1.0) * low[i - 1] -
                       (1.0 - std::numbers::sqrt2 * w + w * w) * low[i - 2]);
    }
    for (std::size_t i = 0; i < rows.size(); ++i) {
      walk += 0.02 * steps[i];
      low[i] += walk;
    }
    EXPECT_EQ(find_running_mean(low, 1e-6), 0U) << seed;
  }
}

TEST(TimeGrid, SamplesThatArriveInBurstsAreEvenlySpaced) {
  std::vector<double> stamps;
  for (int i = 0; i < 8000; ++i) {
    stamps.push_back(0.01 * (i - i % 8 + 8) + 1e-5 * (i % 8));
  }
  for (const std::optional<double> rate : {std::optional<double>(), std::optional(100.0), std::optional(50.0)}) {
    const auto grid = fit_time_grid(stamps, rate);
    ASSERT_TRUE(grid);
    EXPECT_NEAR(grid->stamps.bursts.mean, 8.0, 0.01);
    EXPECT_NEAR(grid->dt_s, 0.01, 1e-6);
    EXPECT_EQ(grid->length, stamps.size());
  }
}

TEST(TimeGrid, SessionsWithGapsBetweenThemAreNoBursts) {
  std::vector<double> stamps;
  for (int i = 0; i < 8000; ++i) {
    const int session = i / 400;
    stamps.push_back(0.01 * i + 300.0 * session);
  }
  const auto grid = fit_time_grid(stamps, 100.0);
  ASSERT_TRUE(grid);
  EXPECT_EQ(grid->stamps.bursts.count, 0U);
}

/// A coarse lattice was read as an output that is clipped: its largest value comes many times without that.
TEST(Lattice, ManyEqualValuesAtTheTopOfACoarseLatticeAreNotClipped) {
  Random random(7);
  std::vector<double> rows(15000);
  for (double& row : rows) {
    row = 0.3 * std::round((72.0 + 0.3 * random.normal()) / 0.3);
  }
  Channel channel;
  channel.unit = *parse_unit("deg/s");
  channel.rows = rows;
  channel.measured = Series::column(rows, channel.unit);
  channel.reference = Series::constant(72.0 * kDegree, rows.size());
  channel.error = channel.against_reference();
  channel.valid = Presence(rows.size());
  EXPECT_EQ(clipped_at(channel), 0.0);
}

/// Two axes at rest and at three rates about z.
struct Table {
  std::deque<std::vector<double>> memory;
  Study study;
};

void add(Table& table, const std::string& id, double rate_deg_s, std::uint64_t seed,
         const std::function<void(std::vector<double>& gx, std::vector<double>& gz)>& spoil = {}) {
  Random random(seed);
  std::vector<double> gx;
  std::vector<double> gz;
  for (int i = 0; i < 5000; ++i) {
    gx.push_back(-0.4 + 0.2 * random.normal());
    gz.push_back(0.3 + rate_deg_s + 0.2 * random.normal());
  }
  if (spoil) {
    spoil(gx, gz);
  }
  RecordingSpec spec;
  spec.id = id;
  spec.rate_hz = 50.0;
  spec.condition.kind = rate_deg_s != 0.0 ? ConditionKind::ConstantRate : ConditionKind::Static;
  spec.condition.axis = "z";
  spec.condition.value = rate_deg_s * kDegree;
  spec.columns["gx"] = {Quantity::AngularRate, "x", *parse_unit("deg/s")};
  spec.columns["gz"] = {Quantity::AngularRate, "z", *parse_unit("deg/s")};
  table.memory.push_back(std::move(gx));
  table.memory.push_back(std::move(gz));
  const std::size_t first = table.memory.size() - 2;
  auto recording = make_study_recording(spec, {"gx", "gz"}, 5000, [&table, first](std::size_t i) {
    return std::span<const double>(table.memory[first + i]);
  });
  ASSERT_TRUE(recording);
  table.study.recordings.push_back(std::move(*recording));
}

Table table_with(const std::function<void(std::vector<double>& gx, std::vector<double>& gz)>& spoil,
                 double rate = 36.0) {
  Table table;
  add(table, "static-1", 0.0, 1);
  add(table, "static-2", 0.0, 2);
  add(table, "rate-18", 18.0, 3);
  add(table, "spoilt", rate, 4, spoil);
  add(table, "rate-72", 72.0, 5);
  settle_channels(table.study);
  return table;
}

double mean_error(const Study& study, std::size_t r, std::size_t c) {
  const auto& error = study.recordings[r].channels[c].error;
  double sum = 0.0;
  for (const double e : error) {
    sum += e / static_cast<double>(error.size());
  }
  return sum / kDegree;
}

TEST(RightRecordings, RightOnesAreNotTouched) {
  const Table table = table_with({});
  const RightedRecordings righted = right_recordings(table.study);
  EXPECT_FALSE(righted.study);
  EXPECT_TRUE(righted.findings.empty());
  EXPECT_TRUE(righted.aside.empty());
}

/// One recording of five with a turned sign was a "turn-on bias of 28.7 deg/s".
TEST(RightRecordings, ATurnedSignIsNamedAndTurnedBack) {
  const Table table =
      table_with([](auto&, auto& gz) { std::transform(gz.begin(), gz.end(), gz.begin(), std::negate<>()); });
  const RightedRecordings righted = right_recordings(table.study);
  ASSERT_EQ(righted.findings.size(), 1U);
  EXPECT_EQ(righted.findings[0].cause->name, "turned_sign");
  EXPECT_EQ(texts_of(righted.findings[0].fault.channels), std::vector<std::string>{"spoilt/gz"});
  EXPECT_NEAR(mean_error(*righted.study, 3, 1), 0.3, 0.02);
}

TEST(RightRecordings, ExchangedAxesAreNamedAndPutBack) {
  const Table table = table_with([](auto& gx, auto& gz) { gx.swap(gz); });
  const RightedRecordings righted = right_recordings(table.study);
  ASSERT_EQ(righted.findings.size(), 1U);
  EXPECT_EQ(righted.findings[0].cause->name, "swapped_axes");
  EXPECT_NEAR(mean_error(*righted.study, 3, 0), -0.4, 0.02);
  EXPECT_NEAR(mean_error(*righted.study, 3, 1), 0.3, 0.02);
}

TEST(RightRecordings, AnotherUnitIsNamedAtRestAndInMotion) {
  for (const double rate : {0.0, 36.0}) {
    const Table table = table_with(
        [](auto& gx, auto& gz) {
          for (auto* const column : {&gx, &gz}) {
            std::transform(column->begin(), column->end(), column->begin(), [](double v) { return v * kDegree; });
          }
        },
        rate);
    const RightedRecordings righted = right_recordings(table.study);
    ASSERT_EQ(righted.findings.size(), 1U) << rate;
    EXPECT_EQ(righted.findings[0].cause->name, "unit_error");
    EXPECT_EQ(righted.findings[0].fault.channels.size(), 2U);
    EXPECT_NE(righted.findings[0].fault.sentence.find("in rad/s, not in deg/s"), std::string::npos);
    EXPECT_NEAR(mean_error(*righted.study, 3, 1), 0.3, 0.02);
  }
}

TEST(RightRecordings, AnotherMotionThanTheOneStatedIsSetAsideAndNotNamed) {
  const Table table = table_with(
      [](auto&, auto& gz) { std::transform(gz.begin(), gz.end(), gz.begin(), [](double v) { return v - 18.0; }); });
  const RightedRecordings righted = right_recordings(table.study);
  EXPECT_TRUE(righted.findings.empty());
  ASSERT_EQ(righted.aside.size(), 1U);
  EXPECT_EQ(righted.aside[0].recording, "spoilt");
  EXPECT_NEAR(righted.aside[0].gain, 0.5, 0.01);
  EXPECT_EQ(group_channels(*righted.study)[1].members.size(), 4U);
}

/// A channel at 25 Hz beside a reference, read at `at(t)`.
Study clocked(Table& table, const std::function<double(double)>& at, double slow, std::uint64_t seed) {
  const auto motion = [](double t) { return 40.0 * std::sin(0.31 * t) + 25.0 * std::sin(1.07 * t + 1.0) - 10.0; };
  Random random(seed);
  std::vector<double> gz;
  std::vector<double> rz;
  double walk = 0.0;
  for (int i = 0; i < 10000; ++i) {
    const double t = 0.04 * i;
    walk = 0.999 * walk + slow * random.normal();
    gz.push_back(0.2 + motion(at(t)) + walk + 0.15 * random.normal());
    rz.push_back(motion(t));
  }
  RecordingSpec spec;
  spec.id = "profile-1";
  spec.rate_hz = 25.0;
  spec.condition.kind = ConditionKind::Profile;
  spec.columns["gz"] = {Quantity::AngularRate, "z", *parse_unit("deg/s")};
  spec.columns["rz"] = {Quantity::ReferenceAngularRate, "z", *parse_unit("deg/s")};
  table.memory.push_back(std::move(gz));
  table.memory.push_back(std::move(rz));
  const std::size_t first = table.memory.size() - 2;
  auto recording = make_study_recording(spec, {"gz", "rz"}, 10000, [&table, first](std::size_t i) {
    return std::span<const double>(table.memory[first + i]);
  });
  Study study;
  study.recordings.push_back(std::move(*recording));
  return study;
}

TEST(ReferenceClock, JumpAndChangeOfRateAreToldApartAndMeasured) {
  Table table;
  const auto jump = find_clock_fault(clocked(table, [](double t) { return t < 170.0 ? t : t - 0.046; }, 0.002, 1), 0);
  ASSERT_TRUE(jump);
  EXPECT_EQ(jump->kind, ClockBreak::Jump);
  EXPECT_GT(jump->statistic, 1000.0);
  EXPECT_NEAR(jump->size.value, 0.046, 0.001);
  EXPECT_LE(jump->size.ci95.low, 0.046);
  EXPECT_GE(jump->size.ci95.high, 0.046);
  EXPECT_NEAR(jump->t0_s.value, 170.0, 3.0);
  const auto rate = find_clock_fault(
      clocked(table, [](double t) { return t < 210.0 ? t : 210.0 + (t - 210.0) * (1.0 + 7e-4); }, 0.002, 2), 0);
  ASSERT_TRUE(rate);
  EXPECT_EQ(rate->kind, ClockBreak::RateChange);
  EXPECT_NEAR(rate->size.value, 7e-4, 2e-5);
  EXPECT_NEAR(rate->t0_s.value, 210.0, 12.0);
}

/// Slow noise beside the motion, an offset and a drift of the whole clock break nothing.
TEST(ReferenceClock, AClockThatOnlyIsLateOrSlowDoesNotBreak) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Table table;
    const auto whole = [seed](double t) { return t * (1.0 + (seed % 2 == 0 ? 5e-5 : 0.0)) - 0.004; };
    const Study study = clocked(table, whole, 0.002 * static_cast<double>(seed % 5), seed);
    EXPECT_FALSE(find_clock_fault(study, 0)) << "seed " << seed;
  }
}

}  // namespace
}  // namespace driftlab::investigate
