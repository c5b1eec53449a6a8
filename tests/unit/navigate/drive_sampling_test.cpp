// Stamped rows of a recorded drive become even readings, and their dates one time scale.
#include "core/navigate/drive/evaluation.hpp"
#include "tests/unit/navigate/drive_fixture.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace driftlab::drive {
namespace {

ImuSample noisy(Random& random, double turn = 0.0) {
  return {0.01 * random.normal(), 0.01 * random.normal(), turn + 0.01 * random.normal(),
          0.1 * random.normal(),  0.1 * random.normal(),  -9.8 + 0.1 * random.normal()};
}

/// A sensor at 97.9 Hz that a computer asks at 100 Hz, for `seconds`.
SensorLog polled(double seconds) {
  Random random(3);
  std::vector<ImuSample> own;
  for (int i = 0; i < static_cast<int>(seconds * 97.9) + 2; ++i) {
    own.push_back(noisy(random, std::sin(0.01 * i)));
  }
  SensorLog log;
  for (int i = 0; i < static_cast<int>(seconds * 100.0); ++i) {
    log.time_s.push_back(0.01 * i);
    log.readings.push_back(own[static_cast<std::size_t>(97.9 * 0.01 * i)]);
  }
  return log;
}

TEST(DriveSampling, DropsWhatAFasterPollRepeatsAndFindsTheSensorsRate) {
  SamplingFacts facts;
  const auto runs = uniform_readings(polled(200.0), {SensorClock::Host, true}, facts);
  ASSERT_TRUE(runs) << runs.error().message;
  EXPECT_TRUE(facts.polled_faster);
  EXPECT_NEAR(static_cast<double>(facts.repeated) / static_cast<double>(facts.rows), 0.021, 0.001);
  EXPECT_NEAR(facts.sensor_rate_hz, 97.9, 0.02);
  ASSERT_EQ(runs->size(), 1U);
  EXPECT_EQ(runs->front().readings.size(), facts.rows - facts.repeated);
  EXPECT_NEAR(1.0 / runs->front().dt_s, 97.9, 0.02);
}

TEST(DriveSampling, KeepsTheRowsOfAStuckSensorAndCountsThem) {
  Random random(4);
  SensorLog log;
  ImuSample held = noisy(random);
  for (int i = 0; i < 5000; ++i) {
    held = i >= 1000 && i < 1200 ? held : noisy(random);
    log.time_s.push_back(0.01 * i);
    log.readings.push_back(held);
  }
  SamplingFacts facts;
  const auto runs = uniform_readings(log, {SensorClock::Sensor, true}, facts);
  ASSERT_TRUE(runs);
  EXPECT_FALSE(facts.polled_faster);
  EXPECT_EQ(facts.stuck, 200U);
  EXPECT_EQ(runs->front().readings.size(), 5000U);
}

TEST(DriveSampling, LosesNoAngleBetweenJitteringStampsAndTheEvenGrid) {
  // Each reading is the mean since the stamp before; the angle over the whole log is the same after resampling.
  Random random(5);
  SensorLog log;
  double angle = 0.0;
  double before = 0.0;
  for (int i = 0; i < 4000; ++i) {
    const double now = 0.01 * i + 0.002 * random.uniform();
    log.time_s.push_back(now);
    log.readings.push_back(noisy(random, 0.5));
    angle += i == 0 ? 0.0 : log.readings.back()[2] * (now - before);
    before = now;
  }
  SamplingFacts facts;
  const auto runs = uniform_readings(log, {SensorClock::Sensor, true}, facts);
  ASSERT_TRUE(runs);
  double resampled = 0.0;
  const UniformRun& run = runs->front();
  for (std::size_t i = 1; i < run.readings.size(); ++i) {
    resampled += run.readings[i][2] * run.dt_s;
  }
  EXPECT_NEAR(resampled, angle, 1e-9);
}

TEST(DriveSampling, BridgesThreeMissingSamplesAndSplitsAtMore) {
  Random random(6);
  SensorLog log;
  for (int i = 0; i < 3000; ++i) {
    const bool lost = (i > 500 && i < 504) || (i > 1500 && i < 1600);
    if (!lost) {
      log.time_s.push_back(0.01 * i);
      log.readings.push_back(noisy(random));
    }
  }
  SamplingFacts facts;
  const auto runs = uniform_readings(log, {SensorClock::Sensor, true}, facts);
  ASSERT_TRUE(runs);
  EXPECT_EQ(facts.gaps_bridged, 1U);
  EXPECT_EQ(facts.samples_bridged, 3U);
  EXPECT_EQ(facts.gaps_splitting, 1U);
  ASSERT_EQ(runs->size(), 2U);
  EXPECT_NEAR((*runs)[1].start_s, 15.99, 1e-9);
}

TEST(DriveTime, DatesUtcOnceAndGoesOnOverTheEndOfAWeek) {
  Table table{{"t"}, {{1751999658.0, 1751999659.0, 1751999660.0}}, {}, {}};
  TimeMeaning meaning{"t", 1.0, false, TimeScale::Utc, 0.0, {}, ""};
  const auto utc = stamp_rows(table, meaning);
  ASSERT_TRUE(utc);
  EXPECT_DOUBLE_EQ(utc->time_s.front(), 1751999658.0 + 18.0);
  table.columns = {{604799.0, 604799.5, 0.0, 0.5}};
  meaning.scale = TimeScale::Gps;
  const auto week = stamp_rows(table, meaning);
  ASSERT_TRUE(week);
  EXPECT_EQ(week->facts.week_rollovers, 1U);
  EXPECT_DOUBLE_EQ(week->time_s.back(), 604800.5);
}

TEST(DriveTime, GoesOnOverALeapSecond) {
  // The last second of 2016 was counted twice. By the leap seconds of the first row alone, half a drive was 1 s off.
  constexpr double kNewDay = 1483228800.0;
  TimeMeaning meaning{"t", 1.0, false, TimeScale::Utc, 0.0, {}, ""};
  const auto gps = [&](std::vector<double> utc) {
    const auto stamped = stamp_rows(Table{{"t"}, {std::move(utc)}, {}, {}}, meaning);
    EXPECT_TRUE(stamped && stamped->facts.leap_within);
    std::vector<double> since;
    for (const double time_s : stamped->time_s) {
      since.push_back(time_s - kNewDay - 17.0);
    }
    return since;
  };
  const std::vector<double> truth{-1.0, -0.5, 0.0, 0.5, 1.0, 1.5};
  EXPECT_EQ(gps({kNewDay - 1.0, kNewDay - 0.5, kNewDay, kNewDay + 0.5, kNewDay, kNewDay + 0.5}), truth)
      << "the first second of the new day twice, as POSIX has it";
  EXPECT_EQ(gps({kNewDay - 1.0, kNewDay - 0.5, kNewDay - 1.0, kNewDay - 0.5, kNewDay, kNewDay + 0.5}), truth)
      << "the last second of the old day twice, as computers count";
  EXPECT_EQ(gps({kNewDay - 1.0, kNewDay, kNewDay, kNewDay + 1.0}), (std::vector<double>{-1.0, 0.0, 1.0, 2.0}))
      << "rows once a second";
  EXPECT_EQ(gps({kNewDay - 1.0, kNewDay - 0.5, kNewDay + 0.5}), (std::vector<double>{-1.0, -0.5, 1.5}))
      << "no row in the second";
}

}  // namespace
}  // namespace driftlab::drive
