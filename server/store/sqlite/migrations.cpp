#include "server/store/sqlite/migrations.hpp"

#include "server/store/digest.hpp"
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
constexpr std::string_view kHistory = "SELECT number, name, sha256 FROM schema_migrations ORDER BY number";
constexpr std::string_view kRemember =
    "INSERT INTO schema_migrations (number, name, sha256, applied_at) VALUES (?, ?, ?, ?)";

tl::unexpected<Error> refused(std::string message, int database_schema, int binary_schema) {
  return fail(ErrorCode::Conflict, std::move(message),
              {{"database_schema", std::to_string(database_schema)}, {"binary_schema", std::to_string(binary_schema)}});
}

/// A file of ours, or an empty one.
Status require_own_file(Connection& connection) {
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

/// Compares the history in the database with the binary's texts; gives the schema number.
Result<int> verify_history(Connection& connection, const std::vector<Migration>& migrations) {
  const auto present = connection.query_integer(kHasHistory);
  if (!present) {
    return fail(present.error());
  }
  if (present->value_or(0) == 0) {
    return 0;
  }
  const int newest = static_cast<int>(migrations.size());
  int schema = 0;
  Statement history = connection.prepare(kHistory);
  while (true) {
    const Result<bool> row = history.step();
    if (!row) {
      return fail(row.error());
    }
    if (!*row) {
      return schema;
    }
    const int number = static_cast<int>(history.integer(0));
    if (number > newest) {
      return refused("The database has schema " + std::to_string(number) + ", but this driftlab knows only " +
                         std::to_string(newest) + "; use the newer driftlab that wrote it.",
                     number, newest);
    }
    const Migration& known = migrations[static_cast<std::size_t>(number - 1)];
    if (number != schema + 1 || history.text(2) != sha256_hex(known.sql)) {
      auto error = refused("Migration " + std::to_string(number) + " (" + history.text(1) +
                               ") in the database is not the one that this driftlab knows.",
                           number, newest);
      error.value().fields.push_back({"migration", std::to_string(number)});
      return error;
    }
    schema = number;
  }
}

/// user_version repeats the newest migration, so that other tools see it without our table.
Status require_user_version(Connection& connection, int schema, int newest) {
  const auto version = connection.query_integer("PRAGMA user_version");
  if (!version) {
    return fail(version.error());
  }
  if (version->value_or(0) != schema) {
    return refused("The database says schema " + std::to_string(version->value_or(0)) + ", but its history ends at " +
                       std::to_string(schema) + ".",
                   static_cast<int>(version->value_or(0)), newest);
  }
  return {};
}

Status apply_steps(Connection& connection, const Migration& migration, const Clock& clock) {
  if (Status history = connection.execute(std::string(kHistoryTable)); !history) {
    return history;
  }
  if (Status applied = connection.execute(migration.sql); !applied) {
    return applied;
  }
  Status remembered = connection.prepare(kRemember)
                          .bind(migration.number, migration.name, sha256_hex(migration.sql), clock.now())
                          .run();
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

Status apply(Connection& connection, const Migration& migration, const Clock& clock) {
  Status status = connection.execute("BEGIN IMMEDIATE");
  if (status) {
    status = apply_steps(connection, migration, clock);
  }
  if (status) {
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
  return {};
}

}  // namespace

Status copy_database(Connection& connection, const std::filesystem::path& target) {
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
  }
  return copied;
}

Status check_integrity(Connection& connection) {
  const auto finding = connection.query_text("PRAGMA quick_check(1)");
  if (!finding) {
    return fail(finding.error());
  }
  if (finding->value_or("") != "ok") {
    return fail(ErrorCode::Io, "The database is damaged: " + finding->value_or("no answer") + ".");
  }
  return {};
}

Result<MigrationOutcome> migrate(Connection& connection, const std::vector<Migration>& migrations,
                                 const std::filesystem::path& backup_directory, const Clock& clock) {
  if (Status own = require_own_file(connection); !own) {
    return fail(own.error());
  }
  const int newest = static_cast<int>(migrations.size());
  const Result<int> schema = verify_history(connection, migrations);
  if (!schema) {
    return fail(schema.error());
  }
  if (Status agrees = require_user_version(connection, *schema, newest); !agrees) {
    return fail(agrees.error());
  }
  MigrationOutcome outcome{*schema, newest, {}};
  if (*schema == newest) {
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
