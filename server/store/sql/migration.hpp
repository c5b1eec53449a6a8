#pragma once
/// What migrations of every engine have in common: numbered SQL texts that are embedded in the binary at build time,
/// and the table in which a database remembers each with the SHA-256 of its text.
///
/// A migration says in its first line which programs may go on working with a database that has it:
/// `-- Programs of schema 20 and later may work beside it.` or `-- No older program may work beside it.` The database
/// keeps that number, so that an older program knows where it stands with a migration that it has never seen.
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

/// The oldest schema whose programs may work with a database that has this migration; its own number where it names no
/// other.
[[nodiscard]] int oldest_beside(const Migration& migration);

/// Compares the history in the database, whose table is there, with the texts of the binary; gives the schema's number,
/// which is beyond the newest of `migrations` where newer ones let this program work beside them.
/// Errors: Conflict (fields "migration", "database_schema", "binary_schema"); DiskFull; Io.
[[nodiscard]] Result<int> verify_history(Connection& connection, const std::vector<Migration>& migrations);

/// Whether a program whose newest migration is `binary_schema` may work with a database of the newer schema
/// `database_schema`. Errors: DiskFull; Io.
[[nodiscard]] Result<bool> may_work_beside(Connection& connection, int binary_schema, int database_schema);

/// Adds a migration to the history.
[[nodiscard]] Status remember_migration(Connection& connection, const Migration& migration, UtcMicros now);

/// A schema that this binary does not work with. Error: Conflict with fields "database_schema" and "binary_schema".
[[nodiscard]] tl::unexpected<Error> refuse_schema(std::string message, int database_schema, int binary_schema);

/// One sentence for the operator about a newer schema beside which this program works; empty where it is no newer one.
[[nodiscard]] std::string told_newer_schema(int database_schema, int binary_schema);

}  // namespace driftlab::server
