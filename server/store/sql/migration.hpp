#pragma once
/// What migrations of every engine have in common: numbered SQL texts that are embedded in the binary at build time,
/// and the table in which a database remembers each with the SHA-256 of its text.
#include "core/signal/result.hpp"
#include "server/store/clock.hpp"
#include "server/store/sql/connection.hpp"

#include <string>
#include <vector>

namespace driftlab::server {

struct Migration {
  int number = 0;  ///< from 1, without holes
  std::string name;
  std::string sql;
};

/// Compares the history in the database, whose table is there, with the texts of the binary; gives the schema's number.
/// Errors: Conflict (fields "migration", "database_schema", "binary_schema"); DiskFull; Io.
[[nodiscard]] Result<int> verify_history(Connection& connection, const std::vector<Migration>& migrations);

/// Adds a migration to the history.
[[nodiscard]] Status remember_migration(Connection& connection, const Migration& migration, UtcMicros now);

/// A schema that this binary does not work with. Error: Conflict with fields "database_schema" and "binary_schema".
[[nodiscard]] tl::unexpected<Error> refuse_schema(std::string message, int database_schema, int binary_schema);

}  // namespace driftlab::server
