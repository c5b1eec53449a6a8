/// Backups by a timer and on request: one at a time, the newest kept, none half.
#include "server/store/backups.hpp"

#include "tests/unit/store/world.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <latch>
#include <thread>

namespace driftlab::server {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

/// A daemon whose backups are empty folders.
class MadeBackups : public testing::Test {
 protected:
  BackupOptions options(std::int64_t every_micros = 0, std::size_t keep = 0) {
    BackupOptions options;
    options.directory = folder_.path() / "backups";
    options.every_micros = every_micros;
    options.keep = keep;
    options.make = [this](const std::filesystem::path& target, const std::string&, const std::stop_token&) {
      if (report_) {
        std::filesystem::create_directory(target);
      }
      return report_;
    };
    options.ended = [this](const Backup& backup) {
      const std::lock_guard<std::mutex> guard(mutex_);
      ended_.push_back(backup);
      changed_.notify_all();
    };
    return options;
  }

  /// The backups that have ended, once there are so many.
  std::vector<Backup> ended(std::size_t count) {
    std::unique_lock<std::mutex> lock(mutex_);
    EXPECT_TRUE(changed_.wait_for(lock, std::chrono::seconds(60), [&] { return ended_.size() >= count; }));
    return ended_;
  }
  [[nodiscard]] std::vector<std::string> folders() const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder_.path() / "backups")) {
      names.push_back(entry.path().filename().string());
    }
    std::sort(names.begin(), names.end());
    return names;
  }

  TemporaryDirectory folder_;
  FakeClock clock_;
  Result<StoreReport> report_ = StoreReport{3, 4096, {}};

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<Backup> ended_;
};

TEST_F(MadeBackups, OneThatIsAskedForIsMadeAndListed) {
  Backups backups(clock_, options());
  backups.start();
  const auto begun = backups.begin();
  ASSERT_TRUE(begun);
  EXPECT_EQ(begun->state, BackupState::Running);
  EXPECT_TRUE(is_backup_name(begun->name)) << begun->name;
  const Backup made = ended(1).front();
  EXPECT_EQ(made.state, BackupState::Complete);
  EXPECT_EQ(made.blobs, 3);
  EXPECT_THAT(folders(), ElementsAre(begun->name));
  ASSERT_THAT(*backups.list(), SizeIs(1));
  EXPECT_EQ(backups.newest(), made.begun_at / 1'000'000 * 1'000'000);
  EXPECT_GT(backups.begin()->name, begun->name) << "of the same second: no two of one name";
}

TEST_F(MadeBackups, WhileOneIsMadeARequestNamesIt) {
  std::latch made(1);
  BackupOptions slow = options();
  slow.make = [&made](const std::filesystem::path&, const std::string&, const std::stop_token&) {
    made.wait();
    return StoreReport{};
  };
  Backups backups(clock_, slow);
  backups.start();
  const std::string name = backups.begin()->name;
  clock_.advance(kMinute);
  EXPECT_EQ(backups.begin()->name, name);
  made.count_down();
  EXPECT_THAT(ended(1), SizeIs(1));
}

TEST_F(MadeBackups, TheTimerBeginsWhenTheNewestIsOldEnough) {
  std::filesystem::create_directories(folder_.path() / "backups/20261117T000000Z");
  for (const char* const name : {"20261117T000001Z.part", "20261116T000000Z.gone", "mine.part"}) {
    std::filesystem::create_directories(folder_.path() / "backups" / name);
  }
  Backups backups(clock_, options(kHour));  // it is the 18th
  backups.start();
  EXPECT_EQ(ended(1).front().state, BackupState::Complete);
  EXPECT_THAT(*backups.list(), SizeIs(2)) << "what is not finished is none";
  EXPECT_THAT(folders(), SizeIs(3)) << "and is removed; what is somebody else's stays";
}

TEST_F(MadeBackups, TheNewestCompleteOnesStay) {
  Backups backups(clock_, options(0, 2));
  backups.start();
  for (std::size_t i = 1; i <= 4; ++i) {
    clock_.advance(kHour);
    ASSERT_TRUE(backups.begin());
    (void)ended(i);
  }
  EXPECT_THAT(folders(), SizeIs(2));
  EXPECT_EQ(folders().back(), ended(4).back().name);
  EXPECT_THAT(*backups.list(), SizeIs(2)) << "those that are there";
  std::filesystem::remove_all(folder_.path() / "backups" / folders().front());
  EXPECT_THAT(*backups.list(), SizeIs(1)) << "whoever took it away";
}

TEST_F(MadeBackups, ADamagedStoreCostsNoOlderBackup) {
  // Older ones may be the only sound ones: a disk that goes bad must not push them out one a day.
  Backups backups(clock_, options(0, 1));
  backups.start();
  ASSERT_TRUE(backups.begin());
  (void)ended(1);
  report_ = StoreReport{3, 4096, {"The bytes of f00d are damaged."}};
  clock_.advance(kHour);
  ASSERT_TRUE(backups.begin());
  EXPECT_EQ(ended(2).back().state, BackupState::Damaged);
  EXPECT_THAT(folders(), SizeIs(2));
}

TEST_F(MadeBackups, AfterADamagedOneTheTimerWaitsItsTimeAlsoAfterARestart) {
  report_ = StoreReport{3, 4096, {"The bytes of f00d are damaged."}};
  BackupOptions timed = options(24 * kHour, 2);
  timed.describe = [this](const std::filesystem::path&) { return *report_; };
  const auto round = [&] {
    Backups backups(clock_, timed);
    backups.start();
    std::this_thread::sleep_for(std::chrono::milliseconds(300));  // one that is due begins at once
  };
  for (int rounds = 0; rounds < 2; ++rounds) {
    round();
    EXPECT_THAT(folders(), SizeIs(1)) << "one, and no other at once";
    clock_.advance(23 * kHour / 2);
  }
  clock_.advance(kHour);
  round();
  EXPECT_THAT(folders(), SizeIs(2)) << "a day has passed";
}

TEST_F(MadeBackups, OfDamagedOnesAFewStayBesideTheSoundOnes) {
  BackupOptions kept = options(0, 2);
  kept.describe = [](const std::filesystem::path& backup) {
    return StoreReport{0, 0, std::vector<std::string>(std::filesystem::is_empty(backup) ? 0 : 1, "Damaged.")};
  };
  kept.make = [this](const std::filesystem::path& target, const std::string&, const std::stop_token&) {
    std::filesystem::create_directories(report_->faults.empty() ? target : target / "damage");
    return report_;
  };
  Backups backups(clock_, kept);
  backups.start();
  std::size_t made = 0;
  const auto make = [&](std::size_t count, std::vector<std::string> faults) {
    report_ = StoreReport{3, 4096, std::move(faults)};
    for (std::size_t i = 0; i < count; ++i) {
      clock_.advance(kHour);
      EXPECT_TRUE(backups.begin());
      (void)ended(++made);
    }
  };
  const auto states = [&] {
    std::vector<BackupState> found;
    const auto listed = backups.list();
    for (const Backup& each : *listed) {
      found.push_back(each.state);
    }
    return found;
  };
  constexpr auto kSound = BackupState::Complete;
  constexpr auto kDamaged = BackupState::Damaged;
  make(2, {});
  make(6, {"The bytes of f00d are damaged."});
  EXPECT_THAT(states(), ElementsAre(kDamaged, kDamaged, kDamaged, kSound, kSound)) << "newest first";
  make(1, {});
  EXPECT_THAT(states(), ElementsAre(kSound, kDamaged, kDamaged, kDamaged, kSound)) << "two sound ones, as told";
  EXPECT_THAT(folders(), SizeIs(5));
}

TEST_F(MadeBackups, OneThatFailsSaysWhyAndTheTimerWaits) {
  report_ = fail(ErrorCode::DiskFull, "The disk is full.");
  Backups backups(clock_, options(kHour));
  backups.start();
  const Backup failed = ended(1).front();
  EXPECT_EQ(failed.state, BackupState::Failed);
  EXPECT_THAT(failed.faults, ElementsAre("The disk is full."));
  EXPECT_EQ(backups.newest(), std::nullopt);
  EXPECT_THAT(folders(), IsEmpty());
}

TEST_F(MadeBackups, WhyOneFailedIsToldWithoutPathsAndToTheLogWithThem) {
  report_ = fail(ErrorCode::NotFound, "There is no database in /srv/lab.", {{"path", "/srv/lab"}});
  Backups backups(clock_, options());
  backups.start();
  ASSERT_TRUE(backups.begin());
  const Backup failed = ended(1).front();
  EXPECT_THAT(failed.faults, ElementsAre("There is no database in [a file that the log names]."));
  ASSERT_TRUE(failed.failure);
  EXPECT_EQ(failed.failure->message, "There is no database in /srv/lab.");
}

TEST_F(MadeBackups, TheTimeWithoutOneBeginsWithTheDaemonWhereThereIsNone) {
  const UtcMicros began = clock_.now();
  Backups backups(clock_, options());
  EXPECT_EQ(Backups(clock_, {}).none_since(), std::nullopt) << "none are made";
  clock_.advance(kHour);
  EXPECT_EQ(backups.none_since(), began);
  report_ = fail(ErrorCode::DiskFull, "The disk is full.");
  backups.start();
  ASSERT_TRUE(backups.begin());
  (void)ended(1);
  EXPECT_EQ(backups.none_since(), began) << "one that failed is none";
}

TEST_F(MadeBackups, WhereTheirDiskIsGoneNoneIsMadeAndTheTimeGoesOn) {
  namespace fs = std::filesystem;
  const fs::path directory = folder_.path() / "backups";
  const fs::path aside = folder_.path() / "aside";
  Backups backups(clock_, options(24 * kHour));
  backups.start();
  const UtcMicros first = ended(1).front().begun_at / 1'000'000 * 1'000'000;
  EXPECT_EQ(backups.none_since(), first);
  fs::rename(directory, aside);
  clock_.advance(kHour);
  EXPECT_EQ(backups.newest(), std::nullopt);
  EXPECT_EQ(backups.none_since(), first) << "not nothing: the alert must not end";
  ASSERT_TRUE(backups.begin());
  const Backup refused = ended(2).back();
  EXPECT_EQ(refused.state, BackupState::Failed);
  EXPECT_THAT(refused.faults, ElementsAre(HasSubstr("is gone, or on another disk")));
  EXPECT_FALSE(fs::exists(directory)) << "the disk below stays as it is";
  fs::create_directory_symlink("/proc", directory);  // another disk, without them
  clock_.advance(kHour);
  ASSERT_TRUE(backups.begin());
  EXPECT_THAT(ended(3).back().faults, ElementsAre(HasSubstr("is gone, or on another disk")));
  fs::remove(directory);
  fs::rename(aside, directory);
  clock_.advance(kHour);
  ASSERT_TRUE(backups.begin());
  EXPECT_EQ(ended(4).back().state, BackupState::Complete) << "it is back";
  fs::remove_all(directory);
  fs::create_directory(directory);
  clock_.advance(kHour);
  ASSERT_TRUE(backups.begin());
  EXPECT_EQ(ended(5).back().state, BackupState::Complete) << "emptied by somebody, and on its disk";
}

TEST_F(MadeBackups, StoppingGivesUpTheOneThatIsMade) {
  std::latch begun(1);
  BackupOptions slow = options();
  slow.make = [&begun](const std::filesystem::path&, const std::string&, const std::stop_token& stop) {
    begun.count_down();
    while (!stop.stop_requested()) {
      std::this_thread::yield();
    }
    return Result<StoreReport>(fail(ErrorCode::Cancelled, "The backup was stopped."));
  };
  Backups backups(clock_, slow);
  backups.start();
  ASSERT_TRUE(backups.begin());
  begun.wait();
  backups.stop();
  EXPECT_EQ(ended(1).front().state, BackupState::Failed);
  EXPECT_FALSE(backups.begin());
}

TEST_F(MadeBackups, WithoutADirectoryThereAreNone) {
  Backups backups(clock_, {});
  backups.start();
  const auto begun = backups.begin();
  ASSERT_FALSE(begun);
  EXPECT_EQ(begun.error().code, ErrorCode::Conflict);
  EXPECT_THAT(begun.error().message, HasSubstr("--backups"));
  EXPECT_THAT(*backups.list(), IsEmpty());
}

}  // namespace
}  // namespace driftlab::server
