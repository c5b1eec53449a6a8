/// What is true of blobs wherever they are kept: in a local folder, in one that is shared, in a database, in an object
/// storage.
#include "server/store/checksums.hpp"
#include "server/store/digest.hpp"
#include "tests/unit/store/blob_suite.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <thread>

namespace driftlab::server {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

constexpr std::chrono::hours kEveryAge{-1};  // also what is dated now
constexpr std::chrono::hours kACentury{24 * 36525};

std::string read_all(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

class BlobSuite : public testing::TestWithParam<BlobStoreUnderTest> {
 protected:
  void SetUp() override {
    if (!GetParam().is_there()) {
      GTEST_SKIP() << "it is not installed";
    }
    blobs_ = GetParam().open(directory_.path(), 1);
    ASSERT_NE(blobs_, nullptr);
  }
  BlobStore& blobs() { return *blobs_; }
  void reopen(int process = 1) {
    blobs_.reset();
    blobs_ = GetParam().open(directory_.path(), process);
    ASSERT_NE(blobs_, nullptr);
  }
  [[nodiscard]] std::unique_ptr<BlobStore> another() { return GetParam().open(directory_.path(), 2); }

  static std::string keep(BlobStore& blobs, std::string_view text, std::string_view columns = "columns") {
    const auto incoming = blobs.begin();
    EXPECT_TRUE(incoming);
    EXPECT_TRUE((*incoming)->append(std::as_bytes(std::span(text))));
    EXPECT_TRUE((*incoming)->seal());
    std::ofstream((*incoming)->columns_path(), std::ios::binary) << columns;
    std::ofstream(pyramid_path((*incoming)->columns_path()), std::ios::binary) << "pyramid of " << columns;
    const Status kept = (*incoming)->keep();
    EXPECT_TRUE(kept) << kept.error().message;
    return (*incoming)->sha256();
  }

  TemporaryDirectory directory_;

 private:
  std::unique_ptr<BlobStore> blobs_;
};

TEST_P(BlobSuite, KeepsWhatItWasGivenAcrossAStart) {
  std::string text(3'000'001, 'x');  // more than one part, and no whole number of them
  for (std::size_t i = 0; i < text.size(); ++i) {
    text[i] = static_cast<char>(i * 2654435761U >> 13U);
  }
  const std::string hash = keep(blobs(), text, "c\n\0\xFF columns");
  EXPECT_EQ(hash, sha256_hex(text));
  reopen();
  EXPECT_EQ(read_all(blobs().bytes_path(hash)), text);
  EXPECT_EQ(read_all(blobs().columns_path(hash)).substr(0, 2), "c\n");
  EXPECT_EQ(*check_columns(blobs().columns_path(hash)), FileState::Sound);
  EXPECT_EQ(*check_columns(pyramid_path(blobs().columns_path(hash))), FileState::Sound);
}

TEST_P(BlobSuite, AnEmptyFileIsAFileToo) {
  const std::string hash = keep(blobs(), "", "");
  reopen(GetParam().is_shared ? 3 : 1);
  EXPECT_TRUE(std::filesystem::exists(blobs().bytes_path(hash)));
  EXPECT_EQ(read_all(blobs().columns_path(hash)), "");
}

TEST_P(BlobSuite, WhatIsNotKeptIsNotThere) {
  {
    const auto incoming = blobs().begin();
    ASSERT_TRUE((*incoming)->append(std::as_bytes(std::span(std::string_view("abc")))));
    ASSERT_TRUE((*incoming)->seal());
  }
  EXPECT_FALSE(std::filesystem::exists(blobs().bytes_path(sha256_hex("abc"))));
  EXPECT_THAT(*blobs().hashes_older_than(kEveryAge), IsEmpty());
}

TEST_P(BlobSuite, TheSameBytesAgainAreOneBlobWithTheNewColumns) {
  const std::string hash = keep(blobs(), "abc", "old");
  EXPECT_EQ(keep(blobs(), "abc", "new"), hash);
  EXPECT_THAT(*blobs().hashes_older_than(kEveryAge), ElementsAre(hash));
  reopen();
  EXPECT_EQ(read_all(blobs().columns_path(hash)), "new");
}

TEST_P(BlobSuite, TheSweeperRemovesWhatIsOldAndLeavesWhatIsKeptAgain) {
  const std::string hash = keep(blobs(), "abc");
  EXPECT_THAT(*blobs().hashes_older_than(kACentury), IsEmpty());
  EXPECT_FALSE(*blobs().remove_if_older(hash, kACentury));
  EXPECT_TRUE(std::filesystem::exists(blobs().bytes_path(hash)));
  EXPECT_TRUE(*blobs().remove_if_older(hash, kEveryAge));
  EXPECT_FALSE(std::filesystem::exists(blobs().bytes_path(hash)));
  EXPECT_FALSE(std::filesystem::exists(blobs().columns_path(hash)));
  EXPECT_THAT(*blobs().hashes_older_than(kEveryAge), IsEmpty());
  keep(blobs(), "abc");
  EXPECT_TRUE(blobs().remove(hash));
  EXPECT_TRUE(blobs().remove(hash)) << "absent: success";
  EXPECT_FALSE(std::filesystem::exists(blobs().bytes_path(hash)));
}

TEST_P(BlobSuite, AnotherProcessReadsWhatOneKeeps) {
  if (!GetParam().is_shared) {
    GTEST_SKIP() << "one process alone";
  }
  const auto other = another();
  const std::string hash = keep(blobs(), "abc", "columns of abc");
  EXPECT_EQ(read_all(other->bytes_path(hash)), "abc");
  EXPECT_EQ(read_all(other->columns_path(hash)), "columns of abc");
  EXPECT_EQ(*check_columns(other->columns_path(hash)), FileState::Sound);
  EXPECT_EQ(*check_columns(pyramid_path(other->columns_path(hash))), FileState::Sound);
  EXPECT_EQ(keep(*other, "def"), sha256_hex("def"));
  EXPECT_EQ(read_all(blobs().bytes_path(sha256_hex("def"))), "def");
}

TEST_P(BlobSuite, AStartLeavesTheUploadsOfOthersAlone) {
  if (!GetParam().is_shared) {
    GTEST_SKIP() << "one process alone";
  }
  const auto incoming = blobs().begin();
  ASSERT_TRUE((*incoming)->append(std::as_bytes(std::span(std::string_view("ab")))));
  const auto other = another();
  ASSERT_TRUE((*incoming)->append(std::as_bytes(std::span(std::string_view("c")))));
  ASSERT_TRUE((*incoming)->seal());
  EXPECT_EQ(read_all((*incoming)->path()), "abc");
  std::ofstream((*incoming)->columns_path()) << "columns";
  EXPECT_TRUE((*incoming)->keep());
  EXPECT_EQ(read_all(other->bytes_path(sha256_hex("abc"))), "abc");
}

TEST_P(BlobSuite, ProcessesThatKeepTheSameAtOnceKeepItOnce) {
  if (!GetParam().is_shared) {
    GTEST_SKIP() << "one process alone";
  }
  const auto other = another();
  for (int round = 0; round < 10; ++round) {
    const std::string text = "round " + std::to_string(round);
    std::thread beside([&] { keep(*other, text); });
    const std::string hash = keep(blobs(), text);
    beside.join();
    EXPECT_EQ(read_all(blobs().bytes_path(hash)), text);
  }
  EXPECT_EQ(blobs().hashes_older_than(kEveryAge)->size(), 10U);
}

INSTANTIATE_TEST_SUITE_P(Places, BlobSuite, testing::ValuesIn(all_blob_stores()),
                         [](const auto& parameter) { return parameter.param.name; });

}  // namespace
}  // namespace driftlab::server
