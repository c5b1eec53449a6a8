#include "server/store/live_recordings.hpp"

#include "tests/unit/store/world.hpp"

#include <gtest/gtest.h>

namespace driftlab::server {
namespace {

class LiveStore : public ::testing::Test {
 protected:
  TemporaryDirectory directory_;
  FakeClock clock_;
};

TEST_F(LiveStore, WhatFailedIsDueTwiceAsLateEachTimeAndNeverLaterThanSixHours) {
  LiveRecordings live(directory_.path() / "live", clock_);
  const std::string id = live.create("{}", "secret", 1, "").value().id;
  clock_.advance(kHour + 1);
  const auto is_due = [&] { return !live.due_since(clock_.now() - kHour).empty(); };
  ASSERT_TRUE(is_due());
  for (std::int64_t pause = kMinute; pause < 6 * kHour; pause *= 2) {
    live.put_off(id);
    clock_.advance(pause - 1);
    EXPECT_FALSE(is_due()) << pause / kMinute << " min";
    clock_.advance(1);
    EXPECT_TRUE(is_due()) << pause / kMinute << " min";
  }
  for (int again = 0; again < 3; ++again) {
    live.put_off(id);
    clock_.advance(6 * kHour - 1);
    EXPECT_FALSE(is_due());
    clock_.advance(1);
    EXPECT_TRUE(is_due());
  }
  EXPECT_EQ(live.untouched_since(clock_.now() - kHour).size(), 1U) << "it is untouched all the time";
}

TEST_F(LiveStore, CountsWhatATokenBeganAndKnowsItAfterARestart) {
  {
    LiveRecordings live(directory_.path() / "live", clock_);
    for (const char* const owner : {"one", "one", "other", ""}) {
      ASSERT_TRUE(live.create("{}", "secret", 1, owner));
    }
  }
  LiveRecordings live(directory_.path() / "live", clock_);
  EXPECT_EQ(live.open_of("one").all, 4);
  EXPECT_EQ(live.open_of("one").of_owner, 2);
  EXPECT_EQ(live.open_of("other").of_owner, 1);
  EXPECT_EQ(live.open_of("nobody").of_owner, 0);
}

}  // namespace
}  // namespace driftlab::server
