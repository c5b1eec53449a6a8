#pragma once
/// The clock of a database, estimated from its answers. Daemons on machines with different clocks share it for the
/// expiry of tokens, the dates of rows and the age of recordings.
#include "server/store/clock.hpp"

#include <chrono>
#include <mutex>
#include <optional>

namespace driftlab::server {

/// Until the database has said what time it is, that of the machine. Thread safe.
class DatabaseClock final : public Clock {
 public:
  using Steady = std::chrono::steady_clock::time_point;

  [[nodiscard]] UtcMicros now() const override { return at(std::chrono::steady_clock::now()); }
  /// The same at a moment of the machine's steady clock.
  [[nodiscard]] UtcMicros at(Steady moment) const;

  /// The database said `time` to a question that was sent at `asked` and answered at `answered`: it was that time
  /// somewhere between. The closest pair is believed, until its age makes it worse than a new one, or a new one says
  /// that the clock was set (another server has taken over).
  void note(Steady asked, UtcMicros time, Steady answered);

 private:
  struct Reading {
    Steady moment;           ///< halfway between question and answer
    UtcMicros time = 0;      ///< of the database then
    double within_us = 0.0;  ///< half of the time between them
  };
  /// How far off a reading may be at a moment: steady clocks of two machines part by some 50 us a second at most.
  [[nodiscard]] static double doubt_us(const Reading& reading, Steady moment);
  [[nodiscard]] static UtcMicros told_by(const Reading& reading, Steady moment);

  mutable std::mutex mutex_;
  std::optional<Reading> best_;
};

}  // namespace driftlab::server
