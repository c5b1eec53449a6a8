#include "server/store/sqlite/sqlite_store.hpp"
#include "tests/unit/store/store_suite.hpp"

namespace driftlab::server {

const std::vector<StoreUnderTest>& all_stores() {
  static const std::vector<StoreUnderTest> stores = {
      {"Sqlite", [](const std::filesystem::path& directory, const Clock& clock) -> std::unique_ptr<Store> {
         SqliteOptions options;
         options.jitter_seed = 1;
         auto opened = open_sqlite_store(directory, clock, options);
         EXPECT_TRUE(opened) << opened.error().message;
         return opened ? std::move(*opened) : nullptr;
       }}};
  return stores;
}

}  // namespace driftlab::server
