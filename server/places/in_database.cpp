#include "server/places/place.hpp"

#ifdef DRIFTLAB_POSTGRES
#include "server/store/postgres/database_files.hpp"
#endif

namespace driftlab::server {

BlobPlace in_database() {
  return {"database", [](const std::string& value) { return value == "database"; },
          [](const std::string& /*value*/) { return std::string(); },
          [](const Settings& /*settings*/) { return std::optional<std::filesystem::path>(); },
          [](const Settings& settings, OpenedStore& store) -> Result<std::unique_ptr<BlobStore>> {
#ifdef DRIFTLAB_POSTGRES
            return open_copied(settings, std::make_unique<DatabaseFiles>(*store.database));
#else
            (void)settings;
            (void)store;
            return fail(ErrorCode::InvalidArgument, "This driftlabd was built without PostgreSQL.",
                        {{"parameter", "blobs"}});
#endif
          }};
}

}  // namespace driftlab::server
