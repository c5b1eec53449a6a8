/// What time it is by the answers of a database.
#include "server/store/postgres/database_clock.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace driftlab::server {
namespace {

using namespace std::chrono_literals;

constexpr UtcMicros kSecond = 1'000'000;
constexpr UtcMicros kNoon = 1'800'000'000 * kSecond;

/// A database whose clock shows kNoon at `start`, asked so long after it, over a way of `there` and `back`.
struct Asked {
  DatabaseClock::Steady start = std::chrono::steady_clock::now();
  DatabaseClock clock;
  UtcMicros set_by = 0;

  void ask(std::chrono::microseconds after, std::chrono::microseconds there, std::chrono::microseconds back) {
    const auto asked = start + after;
    clock.note(asked, kNoon + set_by + (after + there).count(), asked + there + back);
  }
  [[nodiscard]] double error_us(std::chrono::microseconds after) const {
    return std::fabs(static_cast<double>(clock.at(start + after) - (kNoon + set_by + after.count())));
  }
};

TEST(DatabaseClock, IsTheMachinesUntilTheDatabaseHasSpoken) {
  EXPECT_NEAR(static_cast<double>(DatabaseClock().now() - SystemClock().now()), 0.0, 5e6);
}

TEST(DatabaseClock, GoesByTheAnswerThatCameSoonest) {
  Asked database;
  database.ask(0s, 40ms, 0ms);
  EXPECT_LE(database.error_us(1s), 20'000.0);
  database.ask(1s, 100us, 150us);
  EXPECT_LE(database.error_us(2s), 25.0);
  database.ask(2s, 0ms, 300ms);  // slow, and nothing that contradicts: the clock does not swing by 150 ms
  EXPECT_LE(database.error_us(3s), 25.0);
}

TEST(DatabaseClock, AnOldAnswerGivesWayToANewOne) {
  // Two steady clocks part: after an hour an answer within 100 us is worse than a new one within 1 ms.
  Asked database;
  database.ask(0s, 100us, 100us);
  database.ask(1h, 0us, 2ms);
  EXPECT_NEAR(database.error_us(1h), 1000.0, 1.0);
}

TEST(DatabaseClock, AClockThatWasSetIsBelievedAtOnce) {
  // A replica takes over whose clock is three minutes behind: by the old reading tokens would expire too early.
  Asked database;
  database.ask(0s, 100us, 100us);
  database.set_by = -180 * kSecond;
  database.ask(5s, 20ms, 20ms);
  EXPECT_LE(database.error_us(6s), 20'000.0);
}

}  // namespace
}  // namespace driftlab::server
