#include "server/open_store.hpp"

#include "server/move_store.hpp"
#include "server/store/sqlite/sqlite_store.hpp"

#ifdef DRIFTLAB_POSTGRES
#include "server/store/postgres/database_blobs.hpp"
#include "server/store/postgres/postgres_store.hpp"
#endif

#include <filesystem>
#include <fstream>
#include <string>
#include <system_error>

namespace driftlab::server {
namespace {

namespace fs = std::filesystem;

/// Holds the word of the PostgreSQL database whose recordings the directory keeps.
constexpr const char* kIdentityFile = "postgresql-store";
constexpr const char* kSqliteFile = "driftlab.db";
/// The value of --blobs that means no folder.
constexpr std::string_view kInDatabase = "database";

bool is_there(const fs::path& path) {
  std::error_code none;
  return fs::exists(path, none);
}

Result<OpenedStore> open_sqlite(const Settings& settings, const Clock& clock, AuditListener audited) {
  if (is_there(settings.data / kIdentityFile)) {
    return fail(ErrorCode::Conflict,
                "The directory " + settings.data.string() +
                    " keeps the recordings of a PostgreSQL database; name that with --store.",
                {{"parameter", "data"}});
  }
  if (!settings.blobs.empty()) {
    return fail(
        ErrorCode::InvalidArgument,
        "Recordings outside of --data (--blobs) need rows that daemons share; name their database with --store.",
        {{"parameter", "blobs"}});
  }
  if (is_there(settings.data / kMovingFile) && !settings.is_moving) {
    return fail(ErrorCode::Conflict,
                "The store in " + settings.data.string() +
                    " is being moved; let `driftlabd migrate` end, or remove the file `moving` from the source.",
                {{"parameter", "data"}});
  }
  SqliteOptions options;
  options.audited = std::move(audited);
  auto store = open_sqlite_store(settings.data, clock, std::move(options));
  if (!store) {
    return fail(store.error());
  }
  const SqliteFacts& facts = (*store)->facts();
  Json told{{"sqlite", facts.version},
            {"schema_before", facts.schema_before},
            {"schema", facts.schema},
            {"wal_reset_bug", facts.wal_reset_bug_possible ? "present, harmless: one writer" : "absent"}};
  Database* const database = &(*store)->database();
  return OpenedStore{FileHandle(), std::move(*store), std::move(told), database, nullptr, &clock};
}

#ifdef DRIFTLAB_POSTGRES
std::string first_word(const fs::path& path) {
  std::ifstream stream(path);
  std::string word;
  stream >> word;
  return word;
}

/// Rows and recordings that belong to each other, or none of either yet. `data`: the directory of the recordings.
Status bind_directory(const fs::path& data, SqlStore& store, const std::string& identity) {
  const fs::path file = data / kIdentityFile;
  const std::vector<ErrorField> fields = {{"parameter", "data"}};
  if (is_there(file)) {
    return first_word(file) == identity
               ? Status{}
               : fail(ErrorCode::Conflict,
                      "The directory " + data.string() + " keeps the recordings of another database than --store.",
                      fields);
  }
  if (Status made = make_directories(data); !made) {
    return made;
  }
  if (is_there(data / kSqliteFile) || is_there(data / "blobs")) {
    return fail(ErrorCode::Conflict,
                "The directory " + data.string() +
                    " keeps the recordings of an SQLite store; name an empty one for the PostgreSQL database.",
                fields);
  }
  const auto hashes = store.blob_hashes();
  if (!hashes) {
    return fail(hashes.error());
  }
  if (!hashes->empty()) {
    return fail(ErrorCode::Conflict,
                "The recordings of the database are not in " + data.string() + "; name the directory that keeps them.",
                fields);
  }
  return write_secret_file(file, identity + "\n");
}

Result<OpenedStore> open_postgres(const Settings& settings, AuditListener audited) {
  if (Status made = make_directories(settings.data); !made) {
    return fail(made.error());
  }
  auto lock = lock_directory(settings.data, "store.lock");
  if (!lock) {
    return fail(lock.error());
  }
  PostgresOptions options;
  options.lock = settings.blobs.empty() ? DaemonLock::Kind::Alone : DaemonLock::Kind::Together;
  options.application = settings.serves_api ? "driftlabd" : "driftlabd worker";
  options.audited = std::move(audited);
  auto store = open_postgres_store(settings.store, std::move(options));
  if (!store) {
    return fail(store.error());
  }
  const PostgresFacts& facts = (*store)->facts();
  if (settings.blobs != kInDatabase) {
    const fs::path recordings = settings.blobs.empty() ? settings.data : fs::path(settings.blobs);
    if (Status bound = bind_directory(recordings, **store, facts.identity); !bound) {
      return fail(bound.error());
    }
  }
  Json told{{"postgresql", facts.version},
            {"database", facts.database},
            {"schema_before", facts.schema_before},
            {"schema", facts.schema}};
  Coordination* const others = (*store)->coordination();
  Database* const database = &(*store)->database();
  const Clock* const clock = &(*store)->clock();
  return OpenedStore{std::move(*lock), std::move(*store), std::move(told), database, others, clock};
}
#else
Result<OpenedStore> open_postgres(const Settings& /*settings*/, const AuditListener& /*audited*/) {
  return fail(ErrorCode::InvalidArgument, "This driftlabd was built without PostgreSQL (-DDRIFTLAB_POSTGRES=ON).",
              {{"parameter", "store"}});
}
#endif

}  // namespace

Result<OpenedStore> open_store(const Settings& settings, const Clock& clock, AuditListener audited) {
  return settings.store.empty() ? open_sqlite(settings, clock, std::move(audited))
                                : open_postgres(settings, std::move(audited));
}

Result<std::unique_ptr<BlobStore>> open_blobs(const Settings& settings, OpenedStore& opened) {
  if (settings.blobs.empty()) {
    return open_blob_directory(settings.data);
  }
  if (settings.blobs != kInDatabase) {
    return open_shared_blob_directory(settings.blobs);
  }
  const fs::path copies = settings.data / "copies";
  auto local = open_blob_directory(copies);
  if (!local) {
    return local;
  }
#ifdef DRIFTLAB_POSTGRES
  return std::make_unique<DatabaseBlobs>(*opened.database, std::move(*local), copies,
                                         static_cast<std::uintmax_t>(settings.cache_megabytes) * 1'000'000);
#else
  return local;
#endif
}

Result<OpenedStore> open_existing_store(const Settings& settings, const Clock& clock) {
  const fs::path kept = settings.blobs.empty() ? settings.data : fs::path(settings.blobs);
  const bool in_database = settings.blobs == kInDatabase;
  if (!in_database && !is_there(kept / (settings.store.empty() ? kSqliteFile : kIdentityFile))) {
    return fail(ErrorCode::NotFound,
                "There is no database in " + kept.string() + "; name the daemon's directory with --data.");
  }
  return open_store(settings, clock);
}

}  // namespace driftlab::server
