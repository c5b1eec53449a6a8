#pragma once
/// The right to be the only daemon of a database: an advisory lock that a connection of its own holds.
///
/// The server ends it with the connection. Where that breaks, the lock is taken again when somebody asks; what another
/// daemon wrote meanwhile is fenced off like the work of any lost lease.
#include "core/signal/result.hpp"
#include "server/store/postgres/connection_pool.hpp"

#include <memory>
#include <mutex>

namespace driftlab::server {

class DaemonLock {
 public:
  explicit DaemonLock(ConnectionPool::Opener open) : open_(std::move(open)) {}
  /// Takes the lock, or sees that it still holds. Errors: Conflict (another daemon has it); Io. Thread safe.
  [[nodiscard]] Status hold();
  /// The same for the start of a daemon: waits a moment for a connection that has just lost its daemon to end.
  [[nodiscard]] Status hold_at_start();

 private:
  [[nodiscard]] Status take();

  ConnectionPool::Opener open_;
  std::mutex mutex_;
  std::unique_ptr<PostgresConnection> connection_;
};

}  // namespace driftlab::server
