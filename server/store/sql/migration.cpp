#include "server/store/sql/migration.hpp"

#include "server/store/digest.hpp"

#include <charconv>

namespace driftlab::server {
namespace {

constexpr std::string_view kHistory = "SELECT number, name, sha256 FROM schema_migrations ORDER BY number";
constexpr std::string_view kRemember =
    "INSERT INTO schema_migrations (number, name, sha256, applied_at) VALUES (?, ?, ?, ?)";
constexpr std::string_view kRememberOldest = "UPDATE schema_migrations SET oldest = ? WHERE number = ?";
constexpr std::string_view kOldest = "SELECT max(coalesce(oldest, number)) FROM schema_migrations";
constexpr int kFirstWithOldest = 20;  // migrations/*/0020_who_may_work_beside.sql
constexpr std::string_view kBeside = "-- Programs of schema ";
constexpr std::string_view kMayWork = " and later may work beside it.\n";

/// That a migration of the history is one of this program, or a newer one.
Status require_known(const Statement& row, int before, const std::vector<Migration>& migrations) {
  const int newest = static_cast<int>(migrations.size());
  const int number = static_cast<int>(row.integer(0));
  if (number > newest ||
      (number == before + 1 && row.text(2) == sha256_hex(migrations[static_cast<std::size_t>(number - 1)].sql))) {
    return {};
  }
  auto error = refuse_schema("Migration " + std::to_string(number) + " (" + row.text(1) +
                                 ") in the database is not the one that this driftlab knows.",
                             number, newest);
  error.value().fields.push_back({"migration", std::to_string(number)});
  return error;
}

}  // namespace

int oldest_beside(const Migration& migration) {
  const std::string_view text = migration.sql;
  if (!text.starts_with(kBeside)) {
    return migration.number;
  }
  int oldest = 0;
  const char* const begin = text.data() + kBeside.size();
  const auto read = std::from_chars(begin, text.data() + text.size(), oldest);
  const std::string_view rest = text.substr(static_cast<std::size_t>(read.ptr - text.data()));
  const bool holds = read.ec == std::errc() && rest.starts_with(kMayWork) && oldest > 0 && oldest < migration.number;
  return holds ? oldest : migration.number;
}

tl::unexpected<Error> refuse_schema(std::string message, int database_schema, int binary_schema) {
  return fail(ErrorCode::Conflict, std::move(message),
              {{"database_schema", std::to_string(database_schema)}, {"binary_schema", std::to_string(binary_schema)}});
}

Result<bool> may_work_beside(Connection& connection, int binary_schema, int database_schema) {
  if (binary_schema < kFirstWithOldest || database_schema < kFirstWithOldest) {
    return false;
  }
  return connection.query_integer(kOldest).map(
      [&](std::optional<std::int64_t> oldest) { return oldest && *oldest <= binary_schema; });
}

Result<int> verify_history(Connection& connection, const std::vector<Migration>& migrations) {
  const int newest = static_cast<int>(migrations.size());
  int schema = 0;
  {
    Statement history = connection.prepare(kHistory);
    while (true) {
      const Result<bool> row = history.step();
      if (!row) {
        return fail(row.error());
      }
      if (!*row) {
        break;
      }
      if (Status known = require_known(history, schema, migrations); !known) {
        return fail(known.error());
      }
      schema = static_cast<int>(history.integer(0));
    }
  }
  if (schema <= newest) {
    return schema;
  }
  const auto beside = may_work_beside(connection, newest, schema);
  if (!beside) {
    return fail(beside.error());
  }
  if (!*beside) {
    return refuse_schema("The database has schema " + std::to_string(schema) + ", but this driftlab knows only " +
                             std::to_string(newest) + "; use the newer driftlab that wrote it.",
                         schema, newest);
  }
  return schema;
}

Status remember_migration(Connection& connection, const Migration& migration, UtcMicros now) {
  Status remembered =
      connection.prepare(kRemember).bind(migration.number, migration.name, sha256_hex(migration.sql), now).run();
  if (remembered && migration.number >= kFirstWithOldest) {
    remembered = connection.prepare(kRememberOldest).bind(oldest_beside(migration), migration.number).run();
  }
  return remembered;
}

std::string told_newer_schema(int database_schema, int binary_schema) {
  if (database_schema <= binary_schema) {
    return {};
  }
  return "The database has schema " + std::to_string(database_schema) +
         " of a newer driftlab; this one works beside it with schema " + std::to_string(binary_schema) + ".";
}

}  // namespace driftlab::server
