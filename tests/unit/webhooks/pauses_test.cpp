#include "server/webhooks/pauses.hpp"

#include "server/store/webhook_store.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace driftlab::server {
namespace {

constexpr std::int64_t kSecond = 1'000'000;

TEST(DeliveryPause, GrowsSixfoldToSixHoursAndIsDrawnFromItsUpperHalf) {
  std::mt19937_64 generator(1);
  const std::int64_t whole[] = {5, 30, 180, 1080, 6480, 21600, 21600, 21600};
  for (int attempt = 1; attempt <= 8; ++attempt) {
    std::int64_t least = kLongestOwnPauseMicros;
    std::int64_t most = 0;
    for (int draw = 0; draw < 1000; ++draw) {
      const std::int64_t pause = draw_delivery_pause(attempt, 5 * kSecond, generator);
      least = std::min(least, pause);
      most = std::max(most, pause);
    }
    const std::int64_t bound = whole[attempt - 1] * kSecond;
    EXPECT_GE(least, bound / 2);
    EXPECT_LE(most, bound);
    EXPECT_LT(100 * least, 51 * bound);  // of 1000 uniform draws none would be in the lowest 2 % with probability 2e-9
    EXPECT_GT(100 * most, 99 * bound);
  }
}

TEST(DeliveryPause, RetryAfterIsSecondsOrADate) {
  constexpr UtcMicros kNow = 784'111'700 * kSecond;  // Sun, 06 Nov 1994 08:48:20 GMT
  EXPECT_EQ(retry_after_micros("120", kNow), 120 * kSecond);
  EXPECT_EQ(retry_after_micros("0", kNow), 0);
  EXPECT_EQ(retry_after_micros("Sun, 06 Nov 1994 08:49:37 GMT", kNow), 77 * kSecond);
  EXPECT_EQ(retry_after_micros("9223372036854775807", kNow), kLongestDeliveryPauseMicros);
  EXPECT_EQ(retry_after_micros("Sun, 06 Nov 2094 08:49:37 GMT", kNow), kLongestDeliveryPauseMicros);
  for (const char* const value : {"", "-1", "soon", "1.5", "12 s", "Sun, 06 Nov 1994 08:47:37 GMT",
                                  "Sun, 31 Feb 2094 08:49:37 GMT", "Sun, 06 Nov 1994 08:49:37 CET"}) {
    EXPECT_FALSE(retry_after_micros(value, kNow)) << value;
  }
}

}  // namespace
}  // namespace driftlab::server
