#pragma once
/// Opens the store that the settings name: the SQLite file in --data, or a PostgreSQL database (--store).
#include "core/signal/result.hpp"
#include "schema/json/json.hpp"
#include "server/settings.hpp"
#include "server/store/blobs.hpp"
#include "server/store/clock.hpp"
#include "server/store/coordination.hpp"
#include "server/store/files.hpp"
#include "server/store/sql/sql_store.hpp"

#include <memory>
#include <string>

namespace driftlab::server {

struct OpenedStore {
  FileHandle lock;  ///< of the directory, where the store itself does not hold it
  std::unique_ptr<SqlStore> store;
  Json facts;  ///< what opening found, for the log
  /// That of the store, for files that lie in it. Belongs to the store.
  Database* database = nullptr;
  /// Where several daemons have the store together; else nullptr. Belongs to the store.
  Coordination* others = nullptr;
  /// By which its rows are dated: that of a database that daemons share, else the one it was opened with.
  const Clock* clock = nullptr;
  /// The word of a database, which the place of its recordings keeps; empty: they lie in the same directory.
  std::string identity = {};
  /// Transactions that were acknowledged and are not in the database any more.
  std::int64_t lost_commits = 0;
  /// What a database is being filled from by a move; empty: it is not.
  std::string filled_from = {};
};

/// Holds the word of the PostgreSQL database whose recordings a folder keeps.
inline constexpr const char* kIdentityFile = "postgresql-store";
inline constexpr const char* kSqliteFile = "driftlab.db";

/// Locks the directory and opens the store.
/// Errors: those of open_sqlite_store or open_postgres_store; Conflict (the directory belongs to a PostgreSQL
/// database); InvalidArgument (a driftlab that was built without PostgreSQL).
[[nodiscard]] Result<OpenedStore> open_store(const Settings& settings, const Clock& clock, AuditListener audited = {});

/// The recordings of a store that was opened by the same settings. Errors: those of their place
/// (server/places/place.hpp).
[[nodiscard]] Result<std::unique_ptr<BlobStore>> open_blobs(const Settings& settings, OpenedStore& opened);

/// The store, if it was made before: a command makes no new one by a typing error. Error also: NotFound.
[[nodiscard]] Result<OpenedStore> open_existing_store(const Settings& settings, const Clock& clock);

}  // namespace driftlab::server
