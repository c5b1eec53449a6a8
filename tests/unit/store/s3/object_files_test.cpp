/// What is true of an object storage alone: requests that are sent again, uploads in parts, listings of many pages, and
/// the names by which other clients know the objects. Against a real server.
#include "server/store/s3/object_files.hpp"

#include "server/store/digest.hpp"
#include "tests/unit/store/s3/object_storage.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <fstream>
#include <set>

namespace driftlab::server::s3 {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

constexpr std::chrono::hours kEveryAge{-1};  // also what is dated now
constexpr std::chrono::hours kAnHour{1};
constexpr std::size_t kPart = 1U << 20U;

class ObjectStorageTest : public testing::Test {
 protected:
  void SetUp() override {
    if (!ObjectStorage::is_installed()) {
      GTEST_SKIP() << "Swift is not installed";
    }
    storage_ = &ObjectStorage::of_this_process();
    place_ = storage_->place(bucket());
    files_ = open(storage_->key());
  }
  void TearDown() override {
    if (storage_ != nullptr) {
      storage_->tell("pass");
    }
  }
  std::unique_ptr<ObjectFiles> open(const Credentials& key, ClientOptions options = hasty()) {
    return std::make_unique<ObjectFiles>(
        place_, [key]() -> Result<Credentials> { return key; }, names_lock_in(directory_.path()), options, kPart);
  }
  [[nodiscard]] std::string bucket() const { return bucket_for(directory_.path()); }
  std::string tell(const std::string& line) { return storage_->tell(line); }
  int seen(const std::string& within) { return std::stoi(tell("seen " + within)); }

  /// A blob of these bytes, without columns.
  Status store(const std::string& text) {
    const auto path = directory_.path() / "file";
    std::ofstream(path, std::ios::binary) << text;
    const std::array<LocalFile, 1> files{{{kBytes, path}}};
    return files_->store(sha256_hex(text), files);
  }
  std::string read(const std::string& hash) {
    std::string text;
    const auto got = files_->read(hash, kBytes, [&](std::span<const std::byte> bytes) -> Status {
      text.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
      return {};
    });
    return got ? text : got.error().message;
  }
  ObjectFiles& files() { return *files_; }

  TemporaryDirectory directory_;
  Place place_;

 private:
  ObjectStorage* storage_ = nullptr;
  std::unique_ptr<ObjectFiles> files_;
};

std::string large_text() {
  std::string text(2 * kPart + 3, 'x');
  for (std::size_t i = 0; i < text.size(); ++i) {
    text[i] = static_cast<char>(i * 2654435761U >> 13U);
  }
  return text;
}

TEST_F(ObjectStorageTest, NamesObjectsAsAFolderNamesFiles) {
  ASSERT_TRUE(store("abc"));
  const std::string hash = sha256_hex("abc");
  EXPECT_EQ(tell("keys " + bucket()), "lab/blobs/" + hash.substr(0, 2) + "/" + hash);
}

TEST_F(ObjectStorageTest, WhatIsUnavailableForAMomentIsAskedAgain) {
  for (const char* fault : {"unavailable", "broken", "cut", "lost", "skewed"}) {
    tell(std::string("fault ") + fault + " 2 PUT");
    seen("PUT");
    const std::string text = std::string("after ") + fault;
    const Status stored = store(text);
    EXPECT_TRUE(stored) << fault << ": " << stored.error().message;
    EXPECT_GE(seen("PUT"), 3) << fault;
    if (fault != std::string("skewed")) {  // whose answer to HEAD would have no word of it
      tell(std::string("fault ") + fault + " 2 HEAD");
      const Status again = store(text);
      EXPECT_TRUE(again) << fault << ": " << again.error().message;
    }
    tell("pass");
    EXPECT_EQ(read(sha256_hex(text)), text);
  }
}

TEST_F(ObjectStorageTest, ABodyThatIsDamagedOnTheWayIsNotStored) {
  tell("fault damaged_request 1000 PUT");
  const Status stored = store("abc");
  EXPECT_FALSE(stored);
  tell("pass");
  EXPECT_EQ(tell("keys " + bucket()), "");
}

TEST_F(ObjectStorageTest, WhatIsLargeGoesInParts) {
  const std::string text = large_text();
  seen("x");
  ASSERT_TRUE(store(text));
  EXPECT_EQ(seen("partNumber"), 3);
  EXPECT_EQ(read(sha256_hex(text)), text);
}

TEST_F(ObjectStorageTest, AnUploadInPartsOutlivesACutAndAnAnswerThatIsLost) {
  const std::string text = large_text();
  for (const char* fault : {"cut 1 PUT partNumber", "lost 1 PUT partNumber", "unavailable 2 PUT partNumber",
                            "lost 1 POST uploadId", "cut 1 POST"}) {
    tell(std::string("fault ") + fault);
    const Status stored = store(text);
    EXPECT_TRUE(stored) << fault << ": " << stored.error().message;
    tell("pass");
    EXPECT_EQ(read(sha256_hex(text)), text) << fault;
    EXPECT_TRUE(files().remove(sha256_hex(text)));
  }
}

TEST_F(ObjectStorageTest, AnUploadInPartsThatFailsLeavesNothing) {
  tell("fault denied 1000 PUT partNumber");
  EXPECT_FALSE(store(large_text()));
  tell("pass");
  EXPECT_EQ(tell("keys " + bucket()), "");
  EXPECT_EQ(tell("keys " + bucket() + "+segments"), "");
}

TEST_F(ObjectStorageTest, PartsOfAProcessThatWasKilledAreSwept) {
  // Neither its end nor that of its end arrives.
  tell("fault unavailable 1000 POSTDELETE uploadId");
  EXPECT_FALSE(store(large_text()));
  tell("pass");
  EXPECT_THAT(tell("keys " + bucket() + "+segments"), testing::Not(IsEmpty()));
  EXPECT_TRUE(files().hashes_older_than(kAnHour));
  EXPECT_THAT(tell("keys " + bucket() + "+segments"), testing::Not(IsEmpty())) << "it may still be under way";
  EXPECT_TRUE(files().hashes_older_than(kEveryAge));
  EXPECT_EQ(tell("keys " + bucket() + "+segments"), "");
}

TEST_F(ObjectStorageTest, WhatTheSweeperRemovesWhileItIsUploadedIsWrittenAgain) {
  int sweeps = 0;
  // The sweeper had the lock when the bytes were written.
  const NamesLock late = [&](const std::string& blob, const std::function<Status()>& inside) -> Status {
    const auto swept = sweeps++ == 0 ? files().remove(blob) : Status{};
    return swept ? inside() : swept;
  };
  ObjectFiles uploading(
      place_, [key = ObjectStorage::of_this_process().key()]() -> Result<Credentials> { return key; }, late, hasty(),
      kPart);
  const auto path = directory_.path() / "file";
  std::ofstream(path) << "abc";
  const std::array<LocalFile, 1> written{{{kBytes, path}}};
  ASSERT_TRUE(uploading.store(sha256_hex("abc"), written));
  EXPECT_EQ(sweeps, 2);
  EXPECT_EQ(read(sha256_hex("abc")), "abc");
}

TEST_F(ObjectStorageTest, TheSweeperLeavesWhatIsNewInAnyOfItsFiles) {
  ASSERT_TRUE(store("abc"));
  const std::string hash = sha256_hex("abc");
  EXPECT_FALSE(*files().remove_if_older(hash, kAnHour));
  EXPECT_TRUE(*files().remove_if_older(hash, kEveryAge));
  EXPECT_FALSE(*files().remove_if_older(hash, kEveryAge)) << "there is nothing";
}

TEST_F(ObjectStorageTest, ListsMoreThanAPage) {
  const auto key = [own = ObjectStorage::of_this_process().key()]() -> Result<Credentials> { return own; };
  const Client client(place_, key);
  ObjectFiles paging(place_, key, names_lock_in(directory_.path()), hasty(), kPart, 10);
  std::set<std::string> written;
  for (int i = 0; i < 35; ++i) {
    const std::string hash = sha256_hex(std::to_string(i));
    ASSERT_TRUE(client.send({"PUT", "lab/blobs/" + hash.substr(0, 2) + "/" + hash, {}, {}, {}}));
    written.insert(hash);
  }
  ASSERT_TRUE(client.send({"PUT", "lab/blobs/of-somebody-else", {}, {}, {}}));
  const auto found = paging.hashes_older_than(kEveryAge);
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_EQ(std::set<std::string>(found->begin(), found->end()), written);
  EXPECT_EQ(found->size(), written.size());
  EXPECT_THAT(*paging.hashes_older_than(kAnHour), IsEmpty());
}

TEST_F(ObjectStorageTest, AKeyWithoutRightsAndAWrongOneAreSaid) {
  const auto stranger = open(ObjectStorage::of_this_process().key_without_rights());
  EXPECT_THAT(stranger->mark().error().message, HasSubstr("refuses this key"));
  Credentials wrong = ObjectStorage::of_this_process().key();
  wrong.secret += "-or-another";
  const auto refused = open(wrong)->ping();
  EXPECT_EQ(refused.error().code, ErrorCode::Io);
  EXPECT_THAT(refused.error().message, HasSubstr("refuses this key"));
  EXPECT_THAT(refused.error().message, testing::Not(HasSubstr("another")));
}

TEST_F(ObjectStorageTest, ABucketThatIsNotThereIsSaid) {
  place_.bucket = "nowhere";
  const auto nowhere = open(ObjectStorage::of_this_process().key());
  EXPECT_THAT(nowhere->is_empty().error().message, HasSubstr("has no bucket nowhere"));
}

TEST_F(ObjectStorageTest, AQuotaIsAFullDisk) {
  tell("bucket small-" + bucket() + " 1000");
  place_.bucket = "small-" + bucket();
  const auto small = open(ObjectStorage::of_this_process().key());
  const auto path = directory_.path() / "file";
  std::ofstream(path, std::ios::binary) << std::string(2000, 'x');
  const std::array<LocalFile, 1> files{{{kBytes, path}}};
  const Status stored = small->store(sha256_hex(std::string(2000, 'x')), files);
  ASSERT_FALSE(stored);
  EXPECT_EQ(stored.error().code, ErrorCode::DiskFull) << stored.error().message;
}

TEST_F(ObjectStorageTest, TheMarkIsOneOfItsOwn) {
  EXPECT_EQ(*files().mark(), "");
  EXPECT_TRUE(*files().is_empty());
  EXPECT_FALSE(files().ping());
  ASSERT_TRUE(files().write_mark("word"));
  EXPECT_EQ(*files().mark(), "word");
  EXPECT_TRUE(files().ping());
  ASSERT_TRUE(store("abc"));
  EXPECT_FALSE(*files().is_empty());
}

TEST_F(ObjectStorageTest, OneThatNeverAnswersIsGivenUpInTime) {
  tell("fault slow 1000");
  const auto begun = std::chrono::steady_clock::now();
  const Status asked = files().ping();
  ASSERT_FALSE(asked);
  EXPECT_THAT(asked.error().message, HasSubstr("it took too long"));
  EXPECT_LT(std::chrono::steady_clock::now() - begun, std::chrono::seconds(5));
}

TEST_F(ObjectStorageTest, OneThatTricklesIsGivenUpInTime) {
  ASSERT_TRUE(store(std::string(1000, 'x')));
  tell("fault trickle 1000 GET");
  const auto begun = std::chrono::steady_clock::now();
  EXPECT_THAT(read(sha256_hex(std::string(1000, 'x'))), HasSubstr("broke off in its answer: it took too long"));
  EXPECT_LT(std::chrono::steady_clock::now() - begun, std::chrono::seconds(10));
}

TEST_F(ObjectStorageTest, ConnectionsAreKept) {
  ASSERT_TRUE(files().write_mark("word"));
  const auto begun = std::chrono::steady_clock::now();
  for (int i = 0; i < 20; ++i) {
    EXPECT_TRUE(files().ping());
  }
  std::printf("a small object is read in %.1f ms\n",
              std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begun).count() / 20);
}

}  // namespace
}  // namespace driftlab::server::s3
