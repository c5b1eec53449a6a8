#pragma once
/// When a failed attempt is tried again. The same for every store.
#include <chrono>
#include <cstdint>
#include <random>

namespace driftlab::server {

/// Attempts that count before a job is dead.
inline constexpr int kMaxFailures = 5;
/// Fault signals raised by a job's own work before it is dead.
inline constexpr int kMaxFaults = 2;
/// The longest pause between two attempts.
inline constexpr std::int64_t kLongestPauseMicros = 15LL * 60 * 1'000'000;
/// A waiting job rises by one priority for each of these.
inline constexpr std::int64_t kAgeingMicros = 10LL * 60 * 1'000'000;

/// The longest pause after the n-th failure (n >= 1): min(15 min, 4^n s).
[[nodiscard]] std::int64_t pause_bound_micros(int failures);

/// Draws the pause after the n-th failure: uniform over [0, pause_bound_micros(n)] ("full jitter"), so that jobs that
/// failed together do not come back together.
[[nodiscard]] std::int64_t draw_pause_micros(int failures, std::mt19937_64& generator);

/// The same of a bound that the caller has, by a generator of the thread's own.
[[nodiscard]] std::chrono::milliseconds draw_pause(std::chrono::milliseconds bound);

}  // namespace driftlab::server
