/// What is true of blobs when the place where they are kept fails: nothing that was acknowledged is lost, what was not
/// is said in one sentence, an outage is no loss, and a loss is found and healed by the same bytes.
#include "server/store/checksums.hpp"
#include "server/store/digest.hpp"
#include "tests/unit/store/blob_suite.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <string>
#include <tuple>
#include <vector>

namespace driftlab::server {
namespace {

constexpr std::chrono::seconds kSoon{60};

std::string name_of(BlobFault fault) {
  constexpr std::array<const char*, 7> kNames{"Cut", "Unavailable", "Slow", "Full", "Denied", "Damaged", "Missing"};
  return kNames.at(static_cast<std::size_t>(fault));
}

/// Longer than the limit of a full disk, and than a part.
std::string text_of(const std::string& name) {
  std::string text = name;
  while (text.size() < 1'100'000) {
    text += name + std::to_string(text.size());
  }
  return text;
}

Status try_to_keep(BlobStore& blobs, const std::string& text) {
  const auto incoming = blobs.begin();
  if (!incoming) {
    return fail(incoming.error());
  }
  if (Status taken = (*incoming)->append(std::as_bytes(std::span(text))); !taken) {
    return taken;
  }
  if (Status sealed = (*incoming)->seal(); !sealed) {
    return sealed;
  }
  std::ofstream((*incoming)->columns_path(), std::ios::binary) << "columns of " << text.substr(0, 20);
  return (*incoming)->keep();
}

using Case = std::tuple<BlobStoreUnderTest, BlobFault>;

bool is_loss(BlobFault fault) { return fault == BlobFault::Damaged || fault == BlobFault::Missing; }
bool is_outage(BlobFault fault) { return !is_loss(fault); }
bool is_any(BlobFault /*fault*/) { return true; }

/// Every place with each of its faults that counts.
std::vector<Case> cases_of(bool (*counts)(BlobFault)) {
  std::vector<Case> cases;
  for (const BlobStoreUnderTest& store : all_blob_stores()) {
    for (const BlobFault fault : store.faults) {
      if (counts(fault)) {
        cases.emplace_back(store, fault);
      }
    }
  }
  return cases;
}

std::string name_of_case(const testing::TestParamInfo<Case>& parameter) {
  return std::get<0>(parameter.param).name + name_of(std::get<1>(parameter.param));
}

class BlobFaultSuite : public testing::TestWithParam<Case> {
 protected:
  void SetUp() override {
    if (!place().is_there()) {
      GTEST_SKIP() << "it is not installed";
    }
    blobs_ = place().open(directory_.path(), 1);
    ASSERT_NE(blobs_, nullptr);
    ASSERT_TRUE(try_to_keep(*blobs_, before_));
  }
  static const BlobStoreUnderTest& place() { return std::get<0>(GetParam()); }
  static BlobFault fault() { return std::get<1>(GetParam()); }
  [[nodiscard]] Trouble trouble() { return place().trouble(directory_.path(), fault(), sha256_hex(before_)); }

  /// A process that has no copies yet, where there can be one; else the next after the first.
  BlobStore& elsewhere() {
    if (!place().is_shared) {
      blobs_.reset();
    }
    elsewhere_.reset();
    elsewhere_ = place().open(directory_.path(), ++processes_);
    return *elsewhere_;
  }

  static void expect_sound(BlobStore& blobs, const std::string& text) {
    const std::string hash = sha256_hex(text);
    EXPECT_TRUE(blobs.reach(hash, BlobPart::Bytes));
    EXPECT_EQ(*check_bytes(blobs.bytes_path(hash), hash), FileState::Sound);
    EXPECT_EQ(*check_columns(blobs.columns_path(hash)), FileState::Sound);
  }

  /// For people: one sentence, none of its words a key.
  static void expect_sentence(const Error& error) {
    EXPECT_TRUE(error.code == ErrorCode::Io || error.code == ErrorCode::DiskFull) << error.message;
    EXPECT_THAT(error.message, testing::EndsWith("."));
    EXPECT_THAT(error.message, testing::Not(testing::HasSubstr("\n")));
    EXPECT_THAT(error.message, testing::Not(testing::HasSubstr("a-secret")));
  }

  BlobStore& blobs() { return *blobs_; }
  std::string before_ = text_of("kept before");
  std::string during_ = text_of("kept meanwhile");

 private:
  TemporaryDirectory directory_;
  std::unique_ptr<BlobStore> blobs_;
  std::unique_ptr<BlobStore> elsewhere_;
  int processes_ = 1;
};

class BlobOutageSuite : public BlobFaultSuite {};
class BlobLossSuite : public BlobFaultSuite {};

TEST_P(BlobFaultSuite, WhatIsAcknowledgedIsKeptAndTheRestIsSaid) {
  Status kept;
  {
    const Trouble now = trouble();
    const auto begun = std::chrono::steady_clock::now();
    kept = try_to_keep(blobs(), during_);
    EXPECT_LT(std::chrono::steady_clock::now() - begun, kSoon);
    EXPECT_TRUE(!kept || (fault() != BlobFault::Full && fault() != BlobFault::Denied));
    EXPECT_TRUE(fault() != BlobFault::Full || (!kept && kept.error().code == ErrorCode::DiskFull));
  }
  if (!kept) {
    std::printf("%s, %s: %s\n", place().name.c_str(), name_of(fault()).c_str(), kept.error().message.c_str());
    expect_sentence(kept.error());
    const Status again = try_to_keep(blobs(), during_);
    EXPECT_TRUE(again) << again.error().message;
  }
  BlobStore& other = elsewhere();
  expect_sound(other, during_);
  if (!is_loss(fault())) {
    expect_sound(other, before_);
  }
}

TEST_P(BlobOutageSuite, WhatCannotBeReachedIsNoLoss) {
  BlobStore& other = elsewhere();
  const std::string hash = sha256_hex(before_);
  {
    const Trouble now = trouble();
    const auto begun = std::chrono::steady_clock::now();
    const Status reached = other.reach(hash, BlobPart::Bytes);
    EXPECT_LT(std::chrono::steady_clock::now() - begun, kSoon);
    if (reached) {
      EXPECT_EQ(*check_bytes(other.bytes_path(hash), hash), FileState::Sound);
    } else {
      expect_sentence(reached.error());
    }
  }
  expect_sound(other, before_);
}

TEST_P(BlobLossSuite, IsFoundAndHealedByTheSameBytes) {
  const Trouble now = trouble();
  const std::string hash = sha256_hex(before_);
  BlobStore& other = elsewhere();
  EXPECT_TRUE(other.reach(hash, BlobPart::Bytes)) << "a loss is no outage";
  EXPECT_TRUE(other.reach(hash, BlobPart::Columns));
  EXPECT_NE(*check_bytes(other.bytes_path(hash), hash), FileState::Sound);
  EXPECT_NE(*check_columns(other.columns_path(hash)), FileState::Sound);
  const Status healed = try_to_keep(other, before_);
  EXPECT_TRUE(healed) << healed.error().message;
  expect_sound(elsewhere(), before_);
}

INSTANTIATE_TEST_SUITE_P(Places, BlobFaultSuite, testing::ValuesIn(cases_of(is_any)), name_of_case);
INSTANTIATE_TEST_SUITE_P(Places, BlobOutageSuite, testing::ValuesIn(cases_of(is_outage)), name_of_case);
INSTANTIATE_TEST_SUITE_P(Places, BlobLossSuite, testing::ValuesIn(cases_of(is_loss)), name_of_case);

}  // namespace
}  // namespace driftlab::server
