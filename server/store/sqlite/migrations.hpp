#pragma once
/// Forward-only migrations: numbered SQL texts that are embedded in the binary at build time.
///
/// Every applied migration is remembered with the SHA-256 of its text. A database whose history differs from the
/// binary's texts, or that has migrations the binary does not know and may not work beside, is refused before anything
/// in it is changed.
#include "core/signal/result.hpp"
#include "server/store/clock.hpp"
#include "server/store/sql/migration.hpp"
#include "server/store/sqlite/connection.hpp"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace driftlab::server {

/// migrations/sqlite/NNNN_name.sql in order (made by sql/embed_migrations.cmake).
[[nodiscard]] const std::vector<Migration>& embedded_migrations();

/// "drft": marks a file as driftlab's, in the header of the database file.
inline constexpr std::int64_t kApplicationId = 0x64726674;

struct MigrationOutcome {
  int from = 0;                  ///< schema number found; 0 for a new database
  int to = 0;                    ///< beyond the newest of the binary where that works beside a newer one
  std::filesystem::path backup;  ///< the copy made before; empty where none was needed
};

/// Brings the database to the newest of `migrations`, each in its own transaction, after a backup copy into
/// `backup_directory` where there is something to lose. To be called with the directory's lock held.
/// Errors: Conflict (fields "migration", "database_schema", "binary_schema": changed text, newer schema, foreign file);
/// DiskFull; Io; Internal (a migration that fails, and then leaves the database as it was).
[[nodiscard]] Result<MigrationOutcome> migrate(SqliteConnection& connection, const std::vector<Migration>& migrations,
                                               const std::filesystem::path& backup_directory, const Clock& clock);

/// `VACUUM INTO` a temporary file, flush, rename to `target`. Reads through `connection`, changes nothing. Errors:
/// DiskFull, Io.
[[nodiscard]] Status copy_database(SqliteConnection& connection, const std::filesystem::path& target);

/// `PRAGMA quick_check`. Errors: Io, with the first line of its findings.
[[nodiscard]] Status check_integrity(SqliteConnection& connection);

}  // namespace driftlab::server
