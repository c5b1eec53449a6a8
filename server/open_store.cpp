#include "server/open_store.hpp"

#include "server/move_store.hpp"
#include "server/places/place.hpp"
#include "server/store/sqlite/sqlite_store.hpp"

#ifdef DRIFTLAB_POSTGRES
#include "server/store/postgres/postgres_store.hpp"
#endif

#include <filesystem>
#include <string>

namespace driftlab::server {
namespace {

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
  if (is_filled_ahead(settings.data) && !settings.is_moving) {
    return fail(ErrorCode::Conflict,
                "The store in " + settings.data.string() +
                    " is being filled by `driftlabd migrate --ahead`; let the move end, or remove the directory.",
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
  const std::int64_t lost = facts.lost_commits;
  return OpenedStore{FileHandle(), std::move(*store), std::move(told), database, nullptr, &clock, {}, lost};
}

#ifdef DRIFTLAB_POSTGRES
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
  if (!facts.filled_from.empty() && !settings.is_moving) {
    return fail(ErrorCode::Conflict,
                "The database is being filled by `driftlabd migrate` (" + facts.filled_from +
                    "); let the move end, or make the database anew.",
                {{"parameter", "store"}});
  }
  Json told{{"postgresql", facts.version},
            {"database", facts.database},
            {"schema_before", facts.schema_before},
            {"schema", facts.schema}};
  Coordination* const others = (*store)->coordination();
  Database* const database = &(*store)->database();
  const Clock* const clock = &(*store)->clock();
  std::string identity = facts.identity;
  std::string filled_from = facts.filled_from;
  return OpenedStore{
      std::move(*lock),      std::move(*store), std::move(told), database, others, clock, std::move(identity), 0,
      std::move(filled_from)};
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
  const BlobPlace* const place = find_blob_place(settings.blobs);
  return place == nullptr
             ? fail(ErrorCode::InvalidArgument, "There is no such place of recordings.", {{"parameter", "blobs"}})
             : place->open(settings, opened);
}

Result<OpenedStore> open_existing_store(const Settings& settings, const Clock& clock) {
  const BlobPlace* const place = find_blob_place(settings.blobs);
  const auto kept = place != nullptr ? place->folder(settings) : std::nullopt;
  if (kept && !is_there(*kept / (settings.store.empty() ? kSqliteFile : kIdentityFile))) {
    return fail(ErrorCode::NotFound,
                "There is no database in " + kept->string() + "; name the daemon's directory with --data.");
  }
  return open_store(settings, clock);
}

}  // namespace driftlab::server
