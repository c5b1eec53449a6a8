#include "server/store/sql/migration.hpp"

#include "server/store/digest.hpp"

namespace driftlab::server {
namespace {

constexpr std::string_view kHistory = "SELECT number, name, sha256 FROM schema_migrations ORDER BY number";
constexpr std::string_view kRemember =
    "INSERT INTO schema_migrations (number, name, sha256, applied_at) VALUES (?, ?, ?, ?)";

}  // namespace

tl::unexpected<Error> refuse_schema(std::string message, int database_schema, int binary_schema) {
  return fail(ErrorCode::Conflict, std::move(message),
              {{"database_schema", std::to_string(database_schema)}, {"binary_schema", std::to_string(binary_schema)}});
}

Result<int> verify_history(Connection& connection, const std::vector<Migration>& migrations) {
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
      return refuse_schema("The database has schema " + std::to_string(number) + ", but this driftlab knows only " +
                               std::to_string(newest) + "; use the newer driftlab that wrote it.",
                           number, newest);
    }
    const Migration& known = migrations[static_cast<std::size_t>(number - 1)];
    if (number != schema + 1 || history.text(2) != sha256_hex(known.sql)) {
      auto error = refuse_schema("Migration " + std::to_string(number) + " (" + history.text(1) +
                                     ") in the database is not the one that this driftlab knows.",
                                 number, newest);
      error.value().fields.push_back({"migration", std::to_string(number)});
      return error;
    }
    schema = number;
  }
}

Status remember_migration(Connection& connection, const Migration& migration, UtcMicros now) {
  return connection.prepare(kRemember).bind(migration.number, migration.name, sha256_hex(migration.sql), now).run();
}

}  // namespace driftlab::server
