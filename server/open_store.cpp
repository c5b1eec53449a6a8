#include "server/open_store.hpp"

#include "server/store/sqlite/sqlite_store.hpp"

#ifdef DRIFTLAB_POSTGRES
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
  return OpenedStore{FileHandle(), std::move(*store), std::move(told)};
}

#ifdef DRIFTLAB_POSTGRES
std::string first_word(const fs::path& path) {
  std::ifstream stream(path);
  std::string word;
  stream >> word;
  return word;
}

/// Rows and recordings that belong to each other, or none of either yet.
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
  options.exclusive = true;
  options.audited = std::move(audited);
  auto store = open_postgres_store(settings.store, std::move(options));
  if (!store) {
    return fail(store.error());
  }
  const PostgresFacts& facts = (*store)->facts();
  if (Status bound = bind_directory(settings.data, **store, facts.identity); !bound) {
    return fail(bound.error());
  }
  Json told{{"postgresql", facts.version},
            {"database", facts.database},
            {"schema_before", facts.schema_before},
            {"schema", facts.schema}};
  return OpenedStore{std::move(*lock), std::move(*store), std::move(told)};
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

Result<OpenedStore> open_existing_store(const Settings& settings, const Clock& clock) {
  if (!is_there(settings.data / (settings.store.empty() ? kSqliteFile : kIdentityFile))) {
    return fail(ErrorCode::NotFound,
                "There is no database in " + settings.data.string() + "; name the daemon's directory with --data.");
  }
  return open_store(settings, clock);
}

}  // namespace driftlab::server
