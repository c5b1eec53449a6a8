#pragma once
/// The store on SQLite: one file, one writing thread, a few read-only readers.
///
///   <directory>/driftlab.db (-wal, -shm)   the database
///   <directory>/driftlab.commits           how many transactions were acknowledged
///   <directory>/store.lock                 held by the daemon that has it open
///   <directory>/backups/                   a copy from before each migration
///
/// SQLite 3.7.0 to 3.51.2 can damage a database when two connections write or checkpoint at the same moment. Here
/// exactly one connection can: the writer's. Readers are opened read-only, and the lock keeps a second daemon out.
#include "core/signal/result.hpp"
#include "server/store/clock.hpp"
#include "server/store/sql/sql_store.hpp"
#include "server/store/sqlite/migrations.hpp"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace driftlab::server {

class SqliteDatabase;

struct SqliteOptions {
  int readers = 4;
  /// Seeds the jitter of retry delays; nothing: from the operating system.
  std::optional<std::uint64_t> jitter_seed;
  /// The database may not grow beyond this many pages of 4096 bytes (then: DiskFull); 0: no limit but the disk.
  std::int64_t max_pages = 0;
  /// Other migrations than the embedded ones, for tests.
  std::optional<std::vector<Migration>> migrations;
  /// Told of every row of the audit log once it is durable. May be empty.
  AuditListener audited;
};

/// What opening found, for the log.
struct SqliteFacts {
  std::string version;                  ///< of the SQLite library: "3.40.1"
  bool wal_reset_bug_possible = false;  ///< the library has the bug; harmless while only one connection writes
  int schema_before = 0;                ///< 0: the database was made now
  int schema = 0;
  int schema_of_program = 0;     ///< less than `schema` beside a newer one
  std::filesystem::path backup;  ///< made before migrating; empty where none was needed
  std::filesystem::path database;
  std::int64_t lost_commits = 0;  ///< transactions that were acknowledged and are not there (commit_log.hpp)
};

class SqliteStore final : public SqlStore {
 public:
  SqliteStore(std::unique_ptr<SqliteDatabase> database, SqliteFacts facts, std::uint64_t jitter_seed,
              AuditListener audited);
  using SqlStore::database;  // for a copy of every row into another store
  [[nodiscard]] const SqliteFacts& facts() const { return facts_; }
  [[nodiscard]] std::string newer_schema() const override;
  /// A consistent copy of the database while it is in use (VACUUM INTO from a reader). Errors: DiskFull, Io.
  [[nodiscard]] Status copy_to(const std::filesystem::path& target);

 private:
  SqliteFacts facts_;
};

/// Opens the store in `directory`, made if absent: takes the lock, refuses network file systems, checks the database's
/// integrity, migrates it. `clock` must outlive the store.
/// Errors: Conflict (another daemon has it; schema newer than this binary may work beside, or with changed migrations);
/// Io; DiskFull.
[[nodiscard]] Result<std::unique_ptr<SqliteStore>> open_sqlite_store(const std::filesystem::path& directory,
                                                                     const Clock& clock, SqliteOptions options = {});

}  // namespace driftlab::server
