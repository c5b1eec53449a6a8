#pragma once
/// Coordination of several daemons and workers on one database: which process performs each shared duty, which
/// idempotency keys are in use, how many jobs all of them run at a time, and notices of changes.
///
/// A daemon that has its store alone needs no such object. Duties, keys and workers are held by advisory locks of a
/// connection, so that they end with the process that holds them, however it ends. Hints may be lost with a connection,
/// so a process that acts on them also polls the store.
#include "core/signal/result.hpp"

#include <functional>
#include <string>
#include <string_view>

namespace driftlab::server {

/// A duty that one process performs for all of them.
enum class Duty {
  Maintenance,  ///< expired leases, old replies, files without rows
  Scrubbing,    ///< reading stored files back
  Deliveries,   ///< messages to webhooks
};

/// Callbacks for changes by another process. They are called from a thread of the coordination, one at a time.
struct Hints {
  /// A job changed its state, made `progress`, or was asked to `cancel`.
  std::function<void(const std::string& job_id, std::string_view what)> job;
  /// Another process sent these words (`Coordination::tell`).
  std::function<void(const std::string& words)> words;
  /// Tokens or sessions may have changed. Also called every two seconds, so that a revoked token is refused even if the
  /// hint was lost.
  std::function<void()> access;
  /// The connection broke and was made again: hints may have been lost.
  std::function<void()> lost;
};

/// Keys, each held by at most one process at a time.
class SharedKeys {
 public:
  SharedKeys() = default;
  SharedKeys(const SharedKeys&) = delete;
  SharedKeys& operator=(const SharedKeys&) = delete;
  virtual ~SharedKeys() = default;
  /// False: another process holds the key. A process must not ask again for a key that it holds. Errors: Io.
  [[nodiscard]] virtual Result<bool> take_key(std::string_view key) = 0;
  virtual void give_back_key(std::string_view key) = 0;
};

class Coordination : public SharedKeys {
 public:
  /// Whether no other process held the store when this one started. If so, this process keeps the store to itself until
  /// it calls `admit_others`, and others wait.
  [[nodiscard]] virtual bool came_first() const = 0;
  [[nodiscard]] virtual Status admit_others() = 0;
  /// Whether this process holds the duty now. A duty that no process holds is taken by this call. Queries the database
  /// each time.
  [[nodiscard]] virtual bool has_duty(Duty duty) = 0;
  /// Says how many jobs this process runs at a time, until it ends.
  virtual void offer_workers(int count) = 0;
  /// How many jobs all processes run at a time that have the store now. Queries the database. Errors: Io.
  [[nodiscard]] virtual Result<int> workers() = 0;
  /// Sends a hint to all other processes; one too long for a notification (8000 bytes) reaches them as `lost`.
  virtual void tell(std::string_view words) = 0;
  /// Begins to receive hints. Call once.
  virtual void listen(Hints hints) = 0;
  /// Stops receiving hints.
  virtual void stop() = 0;
};

}  // namespace driftlab::server
