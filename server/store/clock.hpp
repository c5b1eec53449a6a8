#pragma once
/// Time and ids are injected, so that unit tests can cover clock jumps, expired leases and the order of ids.
#include <chrono>
#include <cstdint>
#include <string>
#include <string_view>

namespace driftlab::server {

/// Microseconds since 1970-01-01 UTC, without leap seconds: what rows and leases store.
using UtcMicros = std::int64_t;

class Clock {
 public:
  Clock() = default;
  Clock(const Clock&) = delete;
  Clock& operator=(const Clock&) = delete;
  virtual ~Clock() = default;
  /// Thread safe.
  [[nodiscard]] virtual UtcMicros now() const = 0;
};

/// The machine's clock.
class SystemClock final : public Clock {
 public:
  [[nodiscard]] UtcMicros now() const override;
};

/// RFC 3339 in UTC with milliseconds, `2026-11-21T08:30:00.123Z`.
[[nodiscard]] std::string rfc3339(UtcMicros time);

/// A fresh id: `<prefix>_` and 26 characters of Crockford base32 (48 bits of milliseconds, 80 random bits), so that ids
/// sort by creation time. Of two made by one process in the same millisecond the later sorts later too: its random bits
/// are those of the earlier plus a random step. Randomness comes from the operating system. Thread safe.
[[nodiscard]] std::string make_id(std::string_view prefix, UtcMicros now);

/// The least id of that prefix that make_id gives at `time` or later.
[[nodiscard]] std::string first_id(std::string_view prefix, UtcMicros time);

/// True for `<prefix>_` + 26 characters of the alphabet: the only ids that reach a store.
[[nodiscard]] bool is_id(std::string_view text, std::string_view prefix);

}  // namespace driftlab::server
