#pragma once
/// Brings a PostgreSQL database to the schema of this binary: migrations/postgres, with the numbers and names of those
/// of SQLite.
#include "core/signal/result.hpp"
#include "server/store/postgres/connection.hpp"
#include "server/store/sql/migration.hpp"

#include <vector>

namespace driftlab::server {

/// migrations/postgres/NNNN_name.sql in order (made by sql/embed_migrations.cmake).
[[nodiscard]] const std::vector<Migration>& embedded_postgres_migrations();

struct PostgresSchema {
  int from = 0;  ///< schema number found; 0 for an empty database
  int to = 0;
};

/// Applies what is missing in one transaction, while other daemons that start wait. A backup before it is the
/// operator's: pg_dump, or the base backups of the cluster.
/// Errors: Conflict (a newer schema; changed texts; tables of somebody else; no schema to make tables in); Io
/// (read-only, no right to make tables, no answer); DiskFull; Internal (a migration that fails, and leaves the database
/// as it was).
[[nodiscard]] Result<PostgresSchema> migrate(PostgresConnection& connection, const std::vector<Migration>& migrations);

/// Whether the database is still of the schema of this binary. Errors: Conflict; Io.
[[nodiscard]] Status require_schema(Connection& connection, const std::vector<Migration>& migrations);

}  // namespace driftlab::server
