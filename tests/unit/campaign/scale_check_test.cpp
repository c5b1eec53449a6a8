// A scale factor that moved with the change: found by its slope whatever the bias does, told without a margin, and
// never failed more often than the level says.
#include "core/campaign/regression/scale_check.hpp"

#include "core/campaign/regression/bias_check.hpp"
#include "core/process/random.hpp"
#include "core/signal/unit.hpp"
#include "tests/unit/campaign/rate_sessions.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace driftlab::regression {
namespace {

constexpr double kPpm = 1e-6;

/// A gyroscope at rest and at +-90 deg/s about z: one session with this scale factor error and bias [deg/s].
std::vector<ComparedRecording> turned(double scale, double bias) {
  std::vector<ComparedRecording> recordings;
  for (const double rate : {0.0, 90.0, -90.0}) {
    const std::string condition =
        rate == 0.0 ? "static" : "constant_rate:z:" + std::to_string(static_cast<int>(rate)) + ":deg/s";
    recordings.push_back(recording_of_means(
        "at " + condition, condition,
        {{"angular_rate", "z", "deg/s", (1.0 + scale) * rate + bias}, {"angular_rate", "x", "deg/s", 0.001 * rate}}));
  }
  return recordings;
}

/// An accelerometer with z up and down.
std::vector<ComparedRecording> flipped(double scale, double bias_g) {
  return {recording_of_means("up", "six_position:z:up", {{"specific_force", "z", "g", 1.0 + scale + bias_g}}),
          recording_of_means("down", "six_position:z:down", {{"specific_force", "z", "g", -1.0 - scale + bias_g}})};
}

Sessions gyroscopes(const std::vector<double>& scales, double bias) {
  Sessions sessions;
  for (const double scale : scales) {
    sessions.recordings.push_back(turned(scale, bias));
  }
  return sessions;
}

EventCheck checked(const Sessions& before, const Sessions& now, const ScaleMargins& margins) {
  return check_scale_factor(before.power_ups(), now.power_ups(), margins, 0.01);
}

TEST(ScaleCheck, TellsTheMoveWithoutAMarginAndDoesNotTakeABiasForIt) {
  const EventCheck check = checked(gyroscopes({1e-3}, 0.1), gyroscopes({3e-3}, 5.0), {});
  EXPECT_EQ(check.verdict, CheckVerdict::Ok);
  EXPECT_EQ(check.sentence, "gyro z: the scale factor moved by +2000 ppm; no margin is set for it.");
}

TEST(ScaleCheck, FailsWhatMovedBeyondTheMargin) {
  const Sessions before = gyroscopes({1.00e-3, 1.02e-3, 0.98e-3}, 0.1);
  const Sessions now = gyroscopes({3.00e-3, 3.02e-3, 2.98e-3}, 0.3);
  const EventCheck beyond = checked(before, now, {500.0 * kPpm, 0.0});
  EXPECT_EQ(beyond.check, "scale_factor");
  EXPECT_EQ(beyond.verdict, CheckVerdict::Fail);
  EXPECT_EQ(beyond.sentence, "gyro z: the scale factor moved by +2000 ppm, margin 500 ppm.");
  EXPECT_EQ(beyond.sessions.size(), 3U);
  EXPECT_EQ(checked(before, now, {2500.0 * kPpm, 0.0}).verdict, CheckVerdict::Ok);
}

TEST(ScaleCheck, FindsThatOfAnAccelerometerTurnedUpAndDown) {
  Sessions before;
  Sessions now;
  for (int i = 0; i < 3; ++i) {
    before.recordings.push_back(flipped(0.0 + 1e-6 * i, 0.01));
    now.recordings.push_back(flipped(-1e-3 + 1e-6 * i, 0.02));
  }
  const EventCheck check = checked(before, now, {0.0, 500.0 * kPpm});
  EXPECT_EQ(check.verdict, CheckVerdict::Fail);
  EXPECT_EQ(check.sentence, "accel z: the scale factor moved by -1000 ppm, margin 500 ppm.");
}

TEST(ScaleCheck, AddsAReferenceThatWasSubtracted) {
  const auto with_reference = [](double scale) {
    Sessions sessions = gyroscopes({scale, scale, scale}, 0.1);
    for (auto& session : sessions.recordings) {
      for (ComparedRecording& recording : session) {
        ChannelFacts& facts = recording.channels[0].facts;
        facts.mean_of_error = true;
        facts.mean = *facts.mean - (recording.condition == "static"               ? 0.0
                                    : recording.id.find('-') == std::string::npos ? 90.0
                                                                                  : -90.0);
      }
    }
    return sessions;
  };
  EXPECT_EQ(checked(with_reference(0.0), with_reference(2e-3), {}).sentence,
            "gyro z: the scale factor moved by +2000 ppm; no margin is set for it.");
}

TEST(ScaleCheck, SaysWhatAMarginNeeds) {
  const Sessions three = gyroscopes({0.0, 1e-4, 2e-4}, 0.1);
  const EventCheck few = checked(three, gyroscopes({1e-2, 1.1e-2}, 0.1), {500.0 * kPpm, 0.0});
  EXPECT_EQ(few.verdict, CheckVerdict::Note);
  EXPECT_EQ(few.sentence,
            "The scale factor is not tested: its margin needs three sessions an arm, for nobody knows how much the "
            "scale factor of this sensor moves from one power-up to the next.");
  Sessions resting;
  for (int i = 0; i < 3; ++i) {
    resting.recordings.push_back({turned(0.0, 0.1).front()});
  }
  const EventCheck none = checked(three, resting, {500.0 * kPpm, 0.0});
  EXPECT_EQ(none.verdict, CheckVerdict::Note);
  EXPECT_EQ(none.sentence,
            "The scale factor is not tested: no session of both arms has recordings of one axis under two known inputs "
            "(static and constant_rate, or six_position up and down).");
  EXPECT_EQ(checked(three, resting, {}).sentence, "");
}

// At its margin an axis fails in at most the level (2 sigma of 2000 runs at 5 % are 1 %), and at twice the margin in
// most: the difference of means of three has a deviation of 0.8 * 100 ppm, of which the second margin is 6.
TEST(ScaleCheck, KeepsItsLevelAtTheMarginAndHasPowerBeyond) {
  constexpr int kRuns = 2000;
  constexpr double kLevel = 0.05;
  int fails_at = 0;
  int fails_beyond = 0;
  for (int run = 0; run < kRuns; ++run) {
    Random random(67, static_cast<std::uint64_t>(run));
    const auto sessions = [&](double scale) {
      std::vector<double> scales;
      for (int i = 0; i < 3; ++i) {
        scales.push_back(scale + 100.0 * kPpm * random.normal());
      }
      return gyroscopes(scales, 0.1 * random.normal());
    };
    const Sessions before = sessions(0.0);
    const Sessions at = sessions(500.0 * kPpm);
    const Sessions beyond = sessions(1000.0 * kPpm);
    const auto fails = [&](const Sessions& now) {
      return check_scale_factor(before.power_ups(), now.power_ups(), {500.0 * kPpm, 0.0}, kLevel).verdict ==
             CheckVerdict::Fail;
    };
    fails_at += fails(at) ? 1 : 0;
    fails_beyond += fails(beyond) ? 1 : 0;
  }
  EXPECT_LE(fails_at, kRuns * (kLevel + 0.01));
  EXPECT_GT(fails_at, 0);
  EXPECT_GT(fails_beyond, kRuns * 0.9);
}

// At 90 deg/s the mean holds the scale factor: 2000 ppm of it were told as a bias that moved by 0.18 deg/s.
TEST(BiasCheck, LeavesRecordingsOfMotionToTheScaleFactor) {
  const EventCheck check =
      check_bias(gyroscopes({0.0}, 0.1).power_ups(), gyroscopes({2e-3}, 0.15).power_ups(), {}, 0.01);
  EXPECT_EQ(check.sentence, "gyro z: the bias moved by +0.0500 deg/s; no margin is set for it.");
  Sessions moving = gyroscopes({0.0}, 0.1);
  moving.recordings[0].erase(moving.recordings[0].begin());
  const EventCheck none = check_bias(moving.power_ups(), moving.power_ups(), {0.001, 0.0}, 0.01);
  EXPECT_EQ(none.verdict, CheckVerdict::Note);
  EXPECT_EQ(none.sentence, "The bias is not tested: no axis was recorded at rest in both arms.");
}

}  // namespace
}  // namespace driftlab::regression
