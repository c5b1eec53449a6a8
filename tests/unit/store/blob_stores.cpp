#include "tests/unit/store/blob_suite.hpp"

#ifdef DRIFTLAB_POSTGRES
#include "tests/unit/store/postgres/open_blobs.hpp"
#endif

namespace driftlab::server {

const std::vector<BlobStoreUnderTest>& all_blob_stores() {
  static const std::vector<BlobStoreUnderTest> stores = {
      {"Local",
       [](const std::filesystem::path& folder, int /*process*/) -> std::unique_ptr<BlobStore> {
         auto opened = open_blob_directory(folder);
         EXPECT_TRUE(opened) << opened.error().message;
         return opened ? std::move(*opened) : nullptr;
       }},
      {"Shared",
       [](const std::filesystem::path& folder, int /*process*/) -> std::unique_ptr<BlobStore> {
         auto opened = open_shared_blob_directory(folder);
         EXPECT_TRUE(opened) << opened.error().message;
         return opened ? std::move(*opened) : nullptr;
       },
       true},
#ifdef DRIFTLAB_POSTGRES
      {"Postgres", open_database_blobs_under_test, true},
#endif
  };
  return stores;
}

}  // namespace driftlab::server
