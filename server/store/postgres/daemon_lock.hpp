#pragma once
/// The right to work with a database: an advisory lock that a connection of its own holds.
///
/// A daemon whose recordings only it can reach holds the lock alone. Daemons and workers that share their recordings
/// hold it together; the first of them has it alone until it has put the store in order (`admit_others`). The server
/// ends the lock with the connection. If the connection breaks, the lock is taken again at the next call of `hold`;
/// attempts that another process took over meanwhile are fenced off like those of any lost lease.
#include "core/signal/result.hpp"
#include "server/store/postgres/connection_pool.hpp"

#include <memory>
#include <mutex>

namespace driftlab::server {

class DaemonLock {
 public:
  enum class Kind { Alone, Together };

  DaemonLock(ConnectionPool::Opener open, Kind kind) : open_(std::move(open)), kind_(kind) {}
  /// Takes the lock, or sees that it still holds. Errors: Conflict (another daemon has it); Io. Thread safe.
  [[nodiscard]] Status hold();
  /// The same for the start of a daemon: waits a moment for a connection that has just lost its daemon to end, and for
  /// a first one that puts the store in order.
  [[nodiscard]] Status hold_at_start();
  /// Whether no other process held the lock at the start. A lock of the kind Together is then held alone until
  /// `admit_others`.
  [[nodiscard]] bool came_first() const { return came_first_; }
  /// Errors: Io.
  [[nodiscard]] Status admit_others();

 private:
  [[nodiscard]] Status take();
  [[nodiscard]] Result<bool> try_lock(PostgresConnection& connection);

  ConnectionPool::Opener open_;
  const Kind kind_;
  std::mutex mutex_;
  std::unique_ptr<PostgresConnection> connection_;
  bool starting_ = true;
  bool came_first_ = false;
};

}  // namespace driftlab::server
