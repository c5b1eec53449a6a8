// A bias that moved with the change: told, tested with a margin, and never failed more often than the level says.
#include "core/campaign/regression/bias_check.hpp"

#include "core/process/random.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

namespace driftlab::regression {
namespace {

constexpr double kDegS = 0.017453292519943295;

/// GyroSessions of a gyroscope of three axes with these means of z [deg/s]; x and y stay.
struct GyroSessions {
  std::vector<ComparedRecording> recordings;
  std::vector<PowerUp> power_ups;

  explicit GyroSessions(const std::vector<double>& means) {
    for (const double mean : means) {
      ComparedRecording recording;
      recording.id = "rec" + std::to_string(recordings.size());
      recording.condition = "static";
      for (const char* const axis : {"x", "y", "z"}) {
        ComparedChannel channel;
        channel.result.quantity = "angular_rate";
        channel.result.axis = axis;
        channel.result.unit = "deg/s";
        channel.result.samples = 1000;
        channel.facts.mean = *axis == 'z' ? mean : 0.01 * static_cast<double>(recordings.size());
        recording.channels.push_back(channel);
      }
      recordings.push_back(recording);
    }
    for (const ComparedRecording& recording : recordings) {
      power_ups.push_back({recording.id, {&recording}});
    }
  }
};

TEST(BiasCheck, TellsTheLargestMoveWithoutAMargin) {
  const GyroSessions before({0.10, 0.12});
  const GyroSessions now({0.50, 0.52});
  const EventCheck check = check_bias(before.power_ups, now.power_ups, {}, 0.01);
  EXPECT_EQ(check.verdict, CheckVerdict::Ok);
  EXPECT_EQ(check.sentence, "gyro z: the bias moved by +0.400 deg/s; no margin is set for it.");
  EXPECT_FALSE(check.p);
}

TEST(BiasCheck, FailsWhatMovedBeyondTheMarginAndNeedsThreeSessionsAnArm) {
  const GyroSessions before({0.10, 0.12, 0.11});
  const GyroSessions now({0.50, 0.52, 0.49});
  const EventCheck beyond = check_bias(before.power_ups, now.power_ups, {0.1 * kDegS, 0.0}, 0.01);
  EXPECT_EQ(beyond.verdict, CheckVerdict::Fail);
  EXPECT_NE(beyond.sentence.find("margin 0.100 deg/s"), std::string::npos) << beyond.sentence;
  EXPECT_EQ(beyond.sessions.size(), 3U);
  EXPECT_EQ(check_bias(before.power_ups, now.power_ups, {0.5 * kDegS, 0.0}, 0.01).verdict, CheckVerdict::Ok);
  const GyroSessions two({0.50, 0.52});
  const EventCheck few = check_bias(before.power_ups, two.power_ups, {0.1 * kDegS, 0.0}, 0.01);
  EXPECT_EQ(few.verdict, CheckVerdict::Note);
  EXPECT_NE(few.sentence.find("three sessions"), std::string::npos);
  // The margin of the other sensor asks for nothing of this one.
  EXPECT_EQ(check_bias(before.power_ups, two.power_ups, {0.0, 0.1}, 0.01).verdict, CheckVerdict::Ok);
}

// At its margin an axis fails in at most the level: 2 sigma of 2000 runs at 5 % are 1 %.
TEST(BiasCheck, AtItsMarginFailsNoMoreOftenThanTheLevel) {
  constexpr double kLevel = 0.05;
  int fails = 0;
  constexpr int kRuns = 2000;
  for (int run = 0; run < kRuns; ++run) {
    Random random(61, static_cast<std::uint64_t>(run));
    const auto means = [&](double level) {
      return std::vector<double>{level + 0.05 * random.normal(), level + 0.05 * random.normal(),
                                 level + 0.05 * random.normal()};
    };
    const GyroSessions before(means(0.0));
    const GyroSessions now(means(0.2));
    fails += check_bias(before.power_ups, now.power_ups, {0.2 * kDegS, 0.0}, kLevel).verdict == CheckVerdict::Fail;
  }
  EXPECT_LE(fails, kRuns * (kLevel + 0.01));
  EXPECT_GT(fails, 0);
}

}  // namespace
}  // namespace driftlab::regression
