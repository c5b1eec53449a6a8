#include "server/store/clock.hpp"

#include "server/store/crash_point.hpp"
#include "server/store/digest.hpp"
#include "server/store/files.hpp"
#include "server/store/retry_policy.hpp"

#include <gtest/gtest.h>

#include <set>
#include <string>
#include <utility>

namespace driftlab::server {
namespace {

TEST(Rfc3339, WritesUtcWithMilliseconds) {
  EXPECT_EQ(rfc3339(0), "1970-01-01T00:00:00.000Z");
  EXPECT_EQ(rfc3339(1'795'249'800'123'999), "2026-11-21T08:30:00.123Z");
  EXPECT_EQ(rfc3339(951'782'400'000'000), "2000-02-29T00:00:00.000Z");
  EXPECT_EQ(rfc3339(-1), "1969-12-31T23:59:59.999Z");
}

TEST(Ids, SortByTimeAndDiffer) {
  const std::string early = make_id("rec", 1'000'000);
  const std::string late = make_id("rec", 1'001'000);
  EXPECT_EQ(early.size(), 30U);
  EXPECT_LT(early, late);
  std::set<std::string> ids;
  for (int i = 0; i < 1000; ++i) {
    ids.insert(make_id("rec", 5));
  }
  EXPECT_EQ(ids.size(), 1000U);
}

TEST(Ids, SortInTheOrderTheyWereMadeInWithinAMillisecondToo) {
  // Two devices posted within one millisecond were listed in the order of their random bits.
  std::string last = make_id("dev", 77'000);
  for (int i = 0; i < 10'000; ++i) {
    std::string next = make_id("dev", 77'000 + i % 1000);
    ASSERT_LT(last, next);
    last = std::move(next);
  }
  // Steps are random, so that an id does not tell the next one: over 1,000 of them every last character occurs.
  std::set<char> ends;
  for (int i = 0; i < 1000; ++i) {
    ends.insert(make_id("dev", 78'000).back());
  }
  EXPECT_EQ(ends.size(), 32U);
}

TEST(Ids, HoldTheMillisecondsInTheirFirstTenCharacters) {
  // 32^3 milliseconds are a one followed by three zeros.
  EXPECT_EQ(make_id("job", 32768 * 1000LL).substr(0, 14), "job_0000001000");
}

TEST(Ids, AreRecognised) {
  const std::string id = make_id("dev", 12);
  EXPECT_TRUE(is_id(id, "dev"));
  EXPECT_FALSE(is_id(id, "rec"));
  EXPECT_FALSE(is_id(id.substr(1), "dev"));
  EXPECT_FALSE(is_id(id + "0", "dev"));
  EXPECT_FALSE(is_id(id.substr(0, id.size() - 1), "dev"));
  EXPECT_FALSE(is_id("dev_../../../../../../etc/pass", "dev"));
  EXPECT_FALSE(is_id("dev_0000000000000000000000000I", "dev"));
  EXPECT_FALSE(is_id("", "dev"));
}

TEST(SystemClock, AgreesWithTheYear) {
  const SystemClock clock;
  EXPECT_GT(clock.now(), 1'700'000'000'000'000);
}

TEST(Sha256, MatchesThePublishedExamples) {
  // FIPS 180-4 examples (NIST CSRC): the empty text, "abc".
  EXPECT_EQ(sha256_hex(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256_hex("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_TRUE(is_sha256_hex(sha256_hex("abc")));
  EXPECT_FALSE(is_sha256_hex("ABC"));
  EXPECT_FALSE(is_sha256_hex(std::string(64, 'g')));
}

TEST(RetryPause, GrowsFourfoldUpToFifteenMinutes) {
  EXPECT_EQ(pause_bound_micros(1), 4'000'000);
  EXPECT_EQ(pause_bound_micros(2), 16'000'000);
  EXPECT_EQ(pause_bound_micros(4), 256'000'000);
  EXPECT_EQ(pause_bound_micros(5), kLongestPauseMicros);
  EXPECT_EQ(pause_bound_micros(1000), kLongestPauseMicros);
}

TEST(RetryPause, IsUniformOverItsRangeAndRepeatable) {
  std::mt19937_64 first(7);
  std::mt19937_64 second(7);
  constexpr int kDraws = 10'000;
  double sum = 0.0;
  for (int i = 0; i < kDraws; ++i) {
    const std::int64_t pause = draw_pause_micros(1, first);
    EXPECT_EQ(pause, draw_pause_micros(1, second));
    EXPECT_GE(pause, 0);
    EXPECT_LE(pause, 4'000'000);
    sum += static_cast<double>(pause);
  }
  // Mean 2 s, standard error 4 s / sqrt(12 * 10^4) = 0.0115 s; five of them.
  EXPECT_NEAR(sum / kDraws, 2.0e6, 5 * 0.0115e6);
}

TEST(CrashPoint, KnowsItsNamesAndKillsAtTheArmedOne) {
  EXPECT_FALSE(arm_crash_point("upload.nowhere"));
  for (const std::string_view name : crash_point_names()) {
    EXPECT_TRUE(arm_crash_point(name));
  }
  EXPECT_TRUE(arm_crash_point(""));
  crash_point("job.claimed");  // unarmed: nothing happens
  EXPECT_EXIT(
      {
        (void)arm_crash_point("job.claimed");
        crash_point("job.working");
        crash_point("job.claimed");
      },
      testing::KilledBySignal(SIGKILL), "");
}

TEST(FileSystem, SharedOnesAreTold) {
  EXPECT_TRUE(is_network_file_system(0x6969));                          // NFS
  EXPECT_TRUE(is_network_file_system(static_cast<long>(0xFF534D42)));   // CIFS
  EXPECT_TRUE(is_network_file_system(static_cast<int>(0xFE534D42)));    // SMB2, where f_type is a signed int
  EXPECT_FALSE(is_network_file_system(0xEF53));                         // ext4
  EXPECT_FALSE(is_network_file_system(static_cast<long>(0x9123683E)));  // btrfs
  EXPECT_FALSE(is_network_file_system(0x01021994));                     // tmpfs
}

}  // namespace
}  // namespace driftlab::server
