// A full scale that changed on purpose is no regression, and one that changed in silence is one.
#include "core/campaign/regression/comparability.hpp"

#include "core/campaign/regression/event_checks.hpp"
#include "core/signal/unit.hpp"
#include "tests/unit/campaign/rate_sessions.hpp"

#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <vector>

namespace driftlab::regression {
namespace {

constexpr double kDegS = 0.017453292519943295;

/// A session of gyroscope and accelerometer on all axes, with steps of this full scale [deg/s] and one of 2 g.
Sessions ranged(double full_scale, bool stated) {
  std::vector<MeanChannel> channels;
  for (const char* const axis : {"x", "y", "z"}) {
    channels.push_back({"angular_rate", axis, "deg/s", 0.0});
    channels.push_back({"specific_force", axis, "g", 0.0});
  }
  ComparedRecording recording = recording_of_means("at " + std::to_string(full_scale), "static", channels);
  for (ComparedChannel& channel : recording.channels) {
    channel.facts.resolution = (channel.result.quantity == "angular_rate" ? full_scale : 2.0) / 32768.0;
  }
  if (stated) {
    recording.full_scale = {full_scale * kDegS, 2.0 * kStandardGravity};
  }
  return {{{recording}}};
}

EventCheck resolution(const Sessions& before, const Sessions& now) {
  for (const EventCheck& check : check_events(before.power_ups(), now.power_ups(), 0.01)) {
    if (check.check == "resolution") {
      return check;
    }
  }
  return {};
}

TEST(Comparability, AStatedFullScaleThatChangedIsNotCompared) {
  const Sessions before = ranged(250.0, true);
  const Sessions now = ranged(500.0, true);
  const auto found = compare_arms(before.power_ups(), now.power_ups());
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].item, "full_scale");
  EXPECT_EQ(found[0].sentence,
            "The full scale of the gyroscope went from 250 deg/s to 500 deg/s: noise and resolution of another range "
            "say nothing "
            "about the change.");
  EXPECT_EQ(resolution(before, now).verdict, CheckVerdict::Ok);
  EXPECT_TRUE(compare_arms(before.power_ups(), before.power_ups()).empty());
}

TEST(Comparability, AnArmOfTwoRangesSaysSo) {
  Sessions mixed = ranged(250.0, true);
  mixed.recordings.push_back(ranged(2000.0, true).recordings[0]);
  const auto found = compare_arms(ranged(250.0, true).power_ups(), mixed.power_ups());
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].sentence.substr(0, 85),
            "The recordings of the candidate have different full scales of the gyroscope (250 and ");
}

TEST(Comparability, AFullScaleThatOneArmDoesNotStateComparesNothing) {
  EXPECT_TRUE(compare_arms(ranged(250.0, true).power_ups(), ranged(500.0, false).power_ups()).empty());
}

TEST(Comparability, StepsThatGrewOnAllAxesHintAtTheFullScale) {
  const EventCheck check = resolution(ranged(250.0, false), ranged(500.0, false));
  EXPECT_EQ(check.verdict, CheckVerdict::Fail);
  EXPECT_NE(check.sentence.find("as with a full scale 2 times as large: state full_scale"), std::string::npos)
      << check.sentence;
  Sessions one = ranged(250.0, false);
  one.recordings[0][0].channels[0].facts.resolution *= 2.0;  // x alone
  const EventCheck alone = resolution(ranged(250.0, false), one);
  EXPECT_EQ(alone.verdict, CheckVerdict::Fail);
  EXPECT_EQ(alone.sentence.find("full scale"), std::string::npos) << alone.sentence;
}

}  // namespace
}  // namespace driftlab::regression
