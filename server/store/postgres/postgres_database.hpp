#pragma once
/// Transactions of a PostgreSQL database that any number of daemons share.
///
/// A write that depends on rows it has read is SERIALIZABLE: if it conflicts with concurrent writes the server refuses
/// it, and it is run again. So every rule of the tables that holds for one writing thread holds here too. Audited
/// writes wait for each other by a lock on the audit log, taken before anything is read: they extend one chain. Writes
/// that depend only on the row that they change are READ COMMITTED and are never refused for a conflict. A transaction
/// that lost its connection before its COMMIT was sent is run again on another one; after that it may have been stored,
/// and the caller is told so.
#include "server/store/postgres/connection_pool.hpp"
#include "server/store/postgres/database_clock.hpp"
#include "server/store/sql/database.hpp"

#include <atomic>
#include <cstdint>
#include <mutex>
#include <random>

namespace driftlab::server {

class PostgresDatabase final : public Database {
 public:
  /// `clock`: nullptr for that of the server, which is the same for all daemons.
  PostgresDatabase(ConnectionPool::Opener open, int connections, const Clock* clock, std::uint64_t jitter_seed)
      : clock_(clock), jitter_(jitter_seed), pool_(std::move(open), connections, jitter_seed) {}

  [[nodiscard]] UtcMicros now(const Connection& connection) const override;
  /// The clock by which `now` goes, for what is no transaction.
  [[nodiscard]] const Clock& clock() const { return clock_ != nullptr ? *clock_ : told_; }
  /// Another number each time: what other daemons changed is not known here, so that no answer may be kept.
  [[nodiscard]] std::uint64_t changes() const override { return changes_.fetch_add(1, std::memory_order_relaxed); }
  /// Every connection that is there is closed, once it is given back: further work opens another.
  void retire_connections() { pool_.retire(); }

 private:
  [[nodiscard]] Status run_write(WriteKind kind, const std::function<Status(Connection&)>& work) override;
  [[nodiscard]] Status run_read(const std::function<Status(Connection&)>& work) override;
  [[nodiscard]] Status repeat(std::string_view begin, const std::function<Status(Connection&)>& work);
  void pause(int attempt);

  const Clock* clock_;
  DatabaseClock told_;  ///< by the begin of every transaction
  mutable std::atomic<std::uint64_t> changes_{1};
  std::mutex jitter_mutex_;
  std::mt19937_64 jitter_;
  ConnectionPool pool_;
};

}  // namespace driftlab::server
