#include "server/store/sqlite/migrations.hpp"

#include "server/store/crash_point.hpp"
#include "server/store/files.hpp"

#include <algorithm>

namespace driftlab::server {
namespace {

constexpr std::string_view kHistoryTable = R"(
CREATE TABLE IF NOT EXISTS schema_migrations (
  number     INTEGER NOT NULL PRIMARY KEY,
  name       TEXT NOT NULL,
  sha256     TEXT NOT NULL,
  applied_at INTEGER NOT NULL
) STRICT)";
constexpr std::string_view kHasHistory =
    "SELECT count(*) FROM sqlite_schema WHERE type = 'table' AND name = 'schema_migrations'";
constexpr std::string_view kTableCount = "SELECT count(*) FROM sqlite_schema";
/// A file of ours, or an empty one.
Status require_own_file(SqliteConnection& connection) {
  const auto application = connection.query_integer("PRAGMA application_id");
  if (!application) {
    return fail(application.error());
  }
  const auto tables = connection.query_integer(kTableCount);
  if (!tables) {
    return fail(tables.error());
  }
  if (application->value_or(0) != kApplicationId && tables->value_or(0) != 0) {
    return fail(ErrorCode::Conflict, "The file is a SQLite database, but not one that driftlab made.");
  }
  return {};
}

/// The number of the database's schema; 0 for a new one.
Result<int> schema_of(SqliteConnection& connection, const std::vector<Migration>& migrations) {
  const auto present = connection.query_integer(kHasHistory);
  if (!present) {
    return fail(present.error());
  }
  return present->value_or(0) == 0 ? Result<int>(0) : verify_history(connection, migrations);
}

/// user_version repeats the newest migration, so that other tools see it without our table.
Status require_user_version(SqliteConnection& connection, int schema, int newest) {
  const auto version = connection.query_integer("PRAGMA user_version");
  if (!version) {
    return fail(version.error());
  }
  if (version->value_or(0) != schema) {
    return refuse_schema("The database says schema " + std::to_string(version->value_or(0)) +
                             ", but its history ends at " + std::to_string(schema) + ".",
                         static_cast<int>(version->value_or(0)), newest);
  }
  return {};
}

Status apply_steps(SqliteConnection& connection, const Migration& migration, const Clock& clock) {
  if (Status history = connection.execute(std::string(kHistoryTable)); !history) {
    return history;
  }
  if (Status applied = connection.execute(migration.sql); !applied) {
    return applied;
  }
  Status remembered = remember_migration(connection, migration, clock.now());
  if (!remembered) {
    return remembered;
  }
  const auto orphan = connection.query_text("PRAGMA foreign_key_check");
  if (!orphan) {
    return fail(orphan.error());
  }
  if (const std::string table = orphan->value_or(""); !table.empty()) {
    return fail(ErrorCode::Internal, "After the migration a row of " + table + " refers to nothing.");
  }
  // A pragma takes no bound values; both are numbers of our own.
  return connection.execute("PRAGMA user_version=" + std::to_string(migration.number) +
                            "; PRAGMA application_id=" + std::to_string(kApplicationId));
}

Status apply(SqliteConnection& connection, const Migration& migration, const Clock& clock) {
  Status status = connection.execute("BEGIN IMMEDIATE");
  if (status) {
    status = apply_steps(connection, migration, clock);
  }
  if (status) {
    crash_point("migrate.in_step");
    status = connection.execute("COMMIT");
  }
  if (!status) {
    if (connection.in_transaction()) {
      (void)connection.execute("ROLLBACK");
    }
    Error error = std::move(status.error());
    error.message =
        "Migration " + std::to_string(migration.number) + " (" + migration.name + ") failed. " + error.message;
    return fail(std::move(error).with("migration", std::to_string(migration.number)));
  }
  crash_point("migrate.stepped");
  return {};
}

}  // namespace

Status copy_database(SqliteConnection& connection, const std::filesystem::path& target) {
  std::filesystem::path temporary = target;
  temporary += ".part";
  if (Status removed = remove_file(temporary); !removed) {
    return removed;
  }
  Status copied = connection.prepare("VACUUM INTO ?").bind(temporary.string()).run();
  if (copied) {
    copied = sync_path(temporary);
  }
  if (copied) {
    copied = rename_durably(temporary, target);
  }
  if (!copied) {
    (void)remove_file(temporary);
    temporary += "-journal";  // left where the copy was larger than the cache of pages
    (void)remove_file(temporary);
  }
  return copied;
}

Status check_integrity(SqliteConnection& connection) {
  const auto finding = connection.query_text("PRAGMA quick_check(1)");
  if (!finding) {
    return fail(finding.error());
  }
  if (finding->value_or("") != "ok") {
    return fail(ErrorCode::Io, "The database is damaged: " + finding->value_or("no answer") + ".");
  }
  return {};
}

Result<MigrationOutcome> migrate(SqliteConnection& connection, const std::vector<Migration>& migrations,
                                 const std::filesystem::path& backup_directory, const Clock& clock) {
  if (Status own = require_own_file(connection); !own) {
    return fail(own.error());
  }
  const int newest = static_cast<int>(migrations.size());
  const Result<int> schema = schema_of(connection, migrations);
  if (!schema) {
    return fail(schema.error());
  }
  if (Status agrees = require_user_version(connection, *schema, newest); !agrees) {
    return fail(agrees.error());
  }
  MigrationOutcome outcome{*schema, std::max(*schema, newest), {}};
  if (*schema >= newest) {
    return outcome;
  }
  if (*schema > 0) {
    if (Status made = make_directories(backup_directory); !made) {
      return fail(made.error());
    }
    outcome.backup =
        backup_directory / ("schema-" + std::to_string(*schema) + "-" + make_id("at", clock.now()) + ".db");
    if (Status copied = copy_database(connection, outcome.backup); !copied) {
      return fail(copied.error());
    }
    crash_point("migrate.backed_up");
  }
  // Tables that others refer to can only be rebuilt with the keys off; every migration ends with a check of all of
  // them.
  Status status = connection.execute("PRAGMA foreign_keys=OFF");
  for (int number = *schema + 1; status && number <= newest; ++number) {
    status = apply(connection, migrations[static_cast<std::size_t>(number - 1)], clock);
  }
  if (Status restored = connection.execute("PRAGMA foreign_keys=ON"); status && !restored) {
    status = std::move(restored);
  }
  if (!status) {
    return fail(std::move(status.error()));
  }
  return outcome;
}

}  // namespace driftlab::server
