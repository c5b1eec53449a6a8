#include "server/store/sqlite/sqlite_store.hpp"

#include "server/store/files.hpp"
#include "server/store/sqlite/sqlite_database.hpp"

#include <sqlite3.h>

#include <random>

namespace driftlab::server {
namespace {

constexpr int kFirstCountedSchema = 17;  // migrations/sqlite/0017_commits_are_counted.sql

/// 3.7.0 to 3.51.2: https://sqlite.org/wal.html
bool has_wal_reset_bug(int version_number) { return version_number >= 3'007'000 && version_number < 3'051'003; }

Status prepare_directory(const std::filesystem::path& directory) {
  if (Status made = make_directories(directory); !made) {
    return made;
  }
  return require_local_file_system(directory);
}

}  // namespace

SqliteStore::SqliteStore(std::unique_ptr<SqliteDatabase> database, SqliteFacts facts, std::uint64_t jitter_seed,
                         AuditListener audited)
    : SqlStore(std::move(database), jitter_seed, std::move(audited)), facts_(std::move(facts)) {}

std::string SqliteStore::newer_schema() const { return told_newer_schema(facts_.schema, facts_.schema_of_program); }

Status SqliteStore::copy_to(const std::filesystem::path& target) {
  return static_cast<SqliteDatabase&>(database()).copy_to(target);
}

Result<std::unique_ptr<SqliteStore>> open_sqlite_store(const std::filesystem::path& directory, const Clock& clock,
                                                       SqliteOptions options) {
  if (Status prepared = prepare_directory(directory); !prepared) {
    return fail(prepared.error());
  }
  Result<FileHandle> lock = lock_directory(directory, "store.lock");
  if (!lock) {
    return fail(lock.error());
  }
  SqliteFacts facts;
  facts.version = sqlite3_libversion();
  facts.wal_reset_bug_possible = has_wal_reset_bug(sqlite3_libversion_number());
  facts.database = directory / "driftlab.db";
  Result<std::unique_ptr<SqliteConnection>> writer = SqliteConnection::open(facts.database, Access::ReadWrite);
  if (!writer) {
    return fail(writer.error());
  }
  if (Status sound = check_integrity(**writer); !sound) {
    return fail(sound.error());
  }
  const auto& migrations = options.migrations ? *options.migrations : embedded_migrations();
  const Result<MigrationOutcome> migrated = migrate(**writer, migrations, directory / "backups", clock);
  if (!migrated) {
    return fail(migrated.error());
  }
  facts.schema_before = migrated->from;
  facts.schema = migrated->to;
  facts.schema_of_program = static_cast<int>(migrations.size());
  facts.backup = migrated->backup;
  if (options.max_pages > 0) {
    if (Status limited = (*writer)->execute("PRAGMA max_page_count=" + std::to_string(options.max_pages)); !limited) {
      return fail(limited.error());
    }
  }
  // The names of the database's files must survive power loss before anything is acknowledged.
  if (Status synced = sync_path(directory); !synced) {
    return fail(synced.error());
  }
  Result<std::unique_ptr<ReaderPool>> readers = ReaderPool::open(facts.database, options.readers);
  if (!readers) {
    return fail(readers.error());
  }
  std::unique_ptr<CommitLog> commits;
  if (migrated->to >= kFirstCountedSchema) {
    auto opened = CommitLog::open(facts.database, **writer);
    if (!opened) {
      return fail(opened.error());
    }
    commits = std::move(*opened);
    facts.lost_commits = commits->lost();
  }
  const std::uint64_t seed = options.jitter_seed ? *options.jitter_seed : std::random_device{}();
  auto database = std::make_unique<SqliteDatabase>(std::move(*lock), clock, facts.database, std::move(*writer),
                                                   std::move(commits), std::move(*readers));
  return std::make_unique<SqliteStore>(std::move(database), std::move(facts), seed, std::move(options.audited));
}

}  // namespace driftlab::server
