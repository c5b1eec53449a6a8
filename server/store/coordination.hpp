#pragma once
/// What several daemons and workers on one database owe each other: who does for all what one must do, which
/// idempotency keys are in use, and hints of what changed.
///
/// A daemon that has its store alone has no such object. Duties and keys are held by advisory locks of a connection,
/// so that they end with the process that holds them, however it ends. Hints may be lost with a connection, and
/// whoever acts by them looks at the store also without.
#include "core/signal/result.hpp"

#include <functional>
#include <string>
#include <string_view>

namespace driftlab::server {

/// What one process does for all of them.
enum class Duty {
  Maintenance,  ///< expired leases, old replies, files without rows
  Scrubbing,    ///< reading stored files back
  Deliveries,   ///< messages to webhooks
};

/// Of what another process did. Called from a thread of the coordination, one call at a time.
struct Hints {
  /// A job came into a state, made `progress`, or is asked to `cancel`.
  std::function<void(const std::string& job_id, std::string_view what)> job;
  /// Another process told these words (`Coordination::tell`).
  std::function<void(const std::string& words)> words;
  /// Tokens or sessions may be others. Also called every two seconds: nobody stays admitted by a lost hint.
  std::function<void()> access;
  /// The connection broke and is there again: hints may have been lost.
  std::function<void()> lost;
};

/// Keys that one of all processes holds at a time.
class SharedKeys {
 public:
  SharedKeys() = default;
  SharedKeys(const SharedKeys&) = delete;
  SharedKeys& operator=(const SharedKeys&) = delete;
  virtual ~SharedKeys() = default;
  /// False: another process holds it. A process asks for a key that it holds itself no second time. Errors: Io.
  [[nodiscard]] virtual Result<bool> take_key(std::string_view key) = 0;
  virtual void give_back_key(std::string_view key) = 0;
};

class Coordination : public SharedKeys {
 public:
  /// Whether no other process worked with the store when this one came. Nobody comes before `admit_others` then.
  [[nodiscard]] virtual bool came_first() const = 0;
  [[nodiscard]] virtual Status admit_others() = 0;
  /// Whether that duty is this process's now: it is taken where nobody has it. Asks the database each time.
  [[nodiscard]] virtual bool has_duty(Duty duty) = 0;
  /// A hint to all other processes; one that is too long for a notification (8000 bytes) becomes `lost` there.
  virtual void tell(std::string_view words) = 0;
  /// Begins to hear. Once.
  virtual void listen(Hints hints) = 0;
  /// Hears nothing more.
  virtual void stop() = 0;
};

}  // namespace driftlab::server
