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
  int to = 0;    ///< beyond the newest of the binary where that works beside a newer one
};

/// Applies what is missing in one transaction, while other daemons that start wait. Those of an older version may work
/// meanwhile: a lock that they hold is waited for half a second, so that nobody waits behind this for longer, and after
/// a pause everything is tried again, for a minute.
/// `is_alone`: no other process works with the database; a migration beside which those that may be there cannot work
/// is refused otherwise. A backup before it is the operator's: pg_dump, or the base backups of the cluster.
/// Errors: Conflict (a newer schema that does not let this program work beside it; not alone; changed texts; tables of
/// somebody else; no schema to make tables in); Io (read-only, no right to make tables, no answer, locks of others);
/// DiskFull; Internal (a migration that fails, and leaves the database as it was).
[[nodiscard]] Result<PostgresSchema> migrate(PostgresConnection& connection, const std::vector<Migration>& migrations,
                                             bool is_alone = true);

/// The schema of the database, with which this binary may still work. Errors: Conflict; Io.
[[nodiscard]] Result<int> require_schema(Connection& connection, const std::vector<Migration>& migrations);

}  // namespace driftlab::server
