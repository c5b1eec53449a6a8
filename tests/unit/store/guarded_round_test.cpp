/// The daemon's own threads (heartbeat, maintenance, scrubber, deliveries, backups, live recordings) had no try: one
/// exception there, say of an allocation, ended the daemon with all its jobs and uploads.
#include "server/store/guarded_round.hpp"

#include "server/store/backups.hpp"
#include "tests/unit/store/world.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <condition_variable>
#include <mutex>
#include <stdexcept>
#include <string>
#include <vector>

namespace driftlab::server {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

/// What is told while it lives.
class GuardedRound : public testing::Test {
 protected:
  GuardedRound() {
    tell_escapes_to([this](std::string_view where, std::string_view what) {
      told_.push_back(std::string(where) + ": " + std::string(what));
    });
  }
  ~GuardedRound() override { tell_escapes_to({}); }
  GuardedRound(const GuardedRound&) = delete;
  GuardedRound& operator=(const GuardedRound&) = delete;

  std::vector<std::string> told_;
};

TEST_F(GuardedRound, TellsOncePerRoundThatAnExceptionEndedAndGoesOn) {
  int rounds = 0;
  while (rounds < 3) {
    const bool whole = guarded_round("loop", [&] {
      if (++rounds != 2) {
        throw std::runtime_error("round " + std::to_string(rounds));
      }
    });
    EXPECT_EQ(whole, rounds == 2);
  }
  EXPECT_THAT(told_, ElementsAre("loop: round 1", "loop: round 3"));
}

TEST_F(GuardedRound, TellsWhatIsNoStandardException) {
  EXPECT_FALSE(guarded_round("loop", [] { throw 7; }));
  EXPECT_THAT(told_, ElementsAre("loop: an exception of an unknown type"));
}

TEST_F(GuardedRound, SurvivesAListenerThatThrowsAndTheAbsenceOfOne) {
  tell_escapes_to([](std::string_view, std::string_view) { throw std::runtime_error("no memory to log it"); });
  EXPECT_FALSE(guarded_round("loop", [] { throw std::runtime_error("first"); }));
  tell_escapes_to({});
  EXPECT_FALSE(guarded_round("loop", [] { throw std::runtime_error("second"); }));
  EXPECT_THAT(told_, IsEmpty());
}

TEST_F(GuardedRound, ABackupThatThrowsHasFailedAndTheNextIsMade) {
  const TemporaryDirectory folder;
  const FakeClock clock;
  std::mutex mutex;
  std::condition_variable changed;
  std::vector<BackupState> ended;
  int made = 0;
  BackupOptions options;
  options.directory = folder.path() / "backups";
  options.make = [&](const std::filesystem::path&, const std::string&, const std::stop_token&) -> Result<StoreReport> {
    if (++made == 1) {
      throw std::runtime_error("out of descriptors");
    }
    return StoreReport{};
  };
  options.ended = [&](const Backup& backup) {
    const std::lock_guard<std::mutex> guard(mutex);
    ended.push_back(backup.state);
    changed.notify_all();
  };
  Backups backups(clock, options);
  backups.start();
  for (std::size_t count = 1; count <= 2; ++count) {
    ASSERT_TRUE(backups.begin());
    std::unique_lock<std::mutex> lock(mutex);
    ASSERT_TRUE(changed.wait_for(lock, std::chrono::seconds(60), [&] { return ended.size() == count; }));
  }
  backups.stop();
  EXPECT_THAT(ended, ElementsAre(BackupState::Failed, BackupState::Complete));
  EXPECT_THAT(told_, ElementsAre("backups: out of descriptors"));
}

}  // namespace
}  // namespace driftlab::server
