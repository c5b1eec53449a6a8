#pragma once
/// The store on PostgreSQL 15 or later: one database that any number of daemons and workers may share.
///
/// Everything that the store keeps in rows is there; uploaded bytes and columns are not (server/store/blobs.hpp).
/// Leases, pauses and ids go by the clock of the database. What other daemons change is not known here, so that no
/// answer is kept in memory (Store::changes).
#include "core/signal/result.hpp"
#include "server/store/clock.hpp"
#include "server/store/coordination.hpp"
#include "server/store/postgres/daemon_lock.hpp"
#include "server/store/postgres/postgres_database.hpp"
#include "server/store/sql/migration.hpp"
#include "server/store/sql/sql_store.hpp"

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace driftlab::server {

struct PostgresOptions {
  int connections = 16;                   ///< at a time; a daemon needs no more than it has threads that ask
  std::string application = "driftlabd";  ///< as pg_stat_activity names it
  /// Hold the database alone against other daemons, or together with those that do so too (DaemonLock); nothing:
  /// without a lock, for tests.
  std::optional<DaemonLock::Kind> lock;
  /// Seeds the jitter of retry delays and of reconnecting; nothing: from the operating system.
  std::optional<std::uint64_t> jitter_seed;
  /// Another clock than that of the database, for tests. It must outlive the store.
  const Clock* clock = nullptr;
  /// Other migrations than the embedded ones, for tests.
  std::optional<std::vector<Migration>> migrations;
  /// Told of every row of the audit log once it is durable. May be empty.
  AuditListener audited;
};

/// What opening found, for the log.
struct PostgresFacts {
  std::string version;      ///< of the server: "15.18"
  std::string database;     ///< `"driftlab" on db.example:5432`
  int schema_before = 0;    ///< 0: the tables were made now
  int schema = 0;           ///< of the database now, which may be a newer one
  std::string identity;     ///< a word that no other database has
  std::string filled_from;  ///< what is being moved into it; empty: nothing
};

class PostgresStore final : public SqlStore {
 public:
  PostgresStore(std::unique_ptr<PostgresDatabase> postgres, PostgresFacts facts, std::vector<Migration> migrations,
                std::unique_ptr<DaemonLock> lock, std::unique_ptr<Coordination> coordination, std::uint64_t jitter_seed,
                AuditListener audited);
  using SqlStore::database;  // for what lies in the database beside the rows of the store
  [[nodiscard]] const PostgresFacts& facts() const { return facts_; }
  /// The clock by which its rows are dated, that of the database. Lives as long as the store.
  [[nodiscard]] const Clock& clock() const { return clock_; }
  /// The coordination of the daemons on one database; nullptr unless the lock is held together. Lives as long as the
  /// store.
  [[nodiscard]] Coordination* coordination() { return coordination_.get(); }
  /// Also that the database has not been brought to a schema since with which this program may not work, nor taken over
  /// by another daemon. Errors: Conflict; Io.
  [[nodiscard]] Status ping() override;
  /// As the last ping found it.
  [[nodiscard]] std::string newer_schema() const override;

 private:
  const Clock& clock_;
  PostgresFacts facts_;
  std::vector<Migration> migrations_;
  std::atomic<int> database_schema_;
  std::unique_ptr<DaemonLock> lock_;  ///< nullptr: no lock, other daemons are not kept out
  std::unique_ptr<Coordination> coordination_;
};

/// Opens the database at `uri` (postgresql://USER@HOST:PORT/DATABASE) and brings it to the schema of this binary.
/// Errors, each in one sentence: InvalidArgument (no such connection string); Io (no answer, no rights, read-only);
/// Conflict (another version, another encoding, tables of somebody else, another daemon); DiskFull.
[[nodiscard]] Result<std::unique_ptr<PostgresStore>> open_postgres_store(const std::string& uri,
                                                                         PostgresOptions options = {});

}  // namespace driftlab::server
