#include "server/store/sqlite/sqlite_store.hpp"
#include "tests/unit/store/store_suite.hpp"

#ifdef DRIFTLAB_POSTGRES
#include "tests/unit/store/postgres/open.hpp"
#endif

namespace driftlab::server {

const std::vector<StoreUnderTest>& all_stores() {
  static const std::vector<StoreUnderTest> stores = {
      {"Sqlite",
       [](const std::filesystem::path& directory, const Clock& clock) -> std::unique_ptr<Store> {
         SqliteOptions options;
         options.jitter_seed = 1;
         auto opened = open_sqlite_store(directory, clock, options);
         EXPECT_TRUE(opened) << opened.error().message;
         return opened ? std::move(*opened) : nullptr;
       }},
#ifdef DRIFTLAB_POSTGRES
      {"Postgres", open_postgres_under_test},
#endif
  };
  return stores;
}

}  // namespace driftlab::server
