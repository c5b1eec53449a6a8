#include "tests/unit/store/blob_suite.hpp"
#include "tests/unit/store/s3/object_storage.hpp"

#include <signal.h>
#include <sys/resource.h>

#include <fstream>

#ifdef DRIFTLAB_POSTGRES
#include "tests/unit/store/postgres/open_blobs.hpp"
#endif

namespace driftlab::server {
namespace {

void damage(const std::filesystem::path& path) {
  std::fstream stream(path, std::ios::in | std::ios::out | std::ios::binary);
  const char first = static_cast<char>(stream.get());
  stream.seekp(0);
  stream.put(static_cast<char>(first ^ 1));
}

/// A file system that takes no more: no file may grow beyond 100 bytes.
Trouble full_disk() {
  (void)::signal(SIGXFSZ, SIG_IGN);
  ::rlimit before{};
  (void)::getrlimit(RLIMIT_FSIZE, &before);
  const ::rlimit full{100, before.rlim_max};
  (void)::setrlimit(RLIMIT_FSIZE, &full);
  return {new ::rlimit(before), [](const ::rlimit* kept) {
            (void)::setrlimit(RLIMIT_FSIZE, kept);
            delete kept;
          }};
}

/// A folder has no connection, and none of its rights hold for root.
const std::vector<BlobFault> kOfFolders{BlobFault::Full, BlobFault::Damaged, BlobFault::Missing};
#ifdef DRIFTLAB_POSTGRES
/// postgres_test.cpp waits for locks, and tests/api/store_test.py has a database on a small disk.
const std::vector<BlobFault> kOfDatabases{BlobFault::Cut, BlobFault::Unavailable, BlobFault::Denied, BlobFault::Damaged,
                                          BlobFault::Missing};
#endif
const std::vector<BlobFault> kOfObjectStorages{BlobFault::Cut,    BlobFault::Unavailable, BlobFault::Slow,
                                               BlobFault::Full,   BlobFault::Denied,      BlobFault::Damaged,
                                               BlobFault::Missing};

Trouble folder_in_trouble(const std::filesystem::path& folder, BlobFault fault, const std::string& sha256) {
  const std::filesystem::path bytes = folder / "blobs" / sha256.substr(0, 2) / sha256;
  const std::filesystem::path columns = folder / "columns" / sha256.substr(0, 2) / (sha256 + ".columns");
  switch (fault) {
    case BlobFault::Full:
      return full_disk();
    case BlobFault::Damaged:
      damage(bytes);
      damage(columns);
      return std::make_shared<int>(0);
    case BlobFault::Missing:
      std::filesystem::remove(bytes);
      std::filesystem::remove(columns);
      return std::make_shared<int>(0);
    case BlobFault::Cut:
    case BlobFault::Unavailable:
    case BlobFault::Slow:
    case BlobFault::Denied:
      break;
  }
  ADD_FAILURE() << "a folder has no such fault";
  return nullptr;
}

}  // namespace

const std::vector<BlobStoreUnderTest>& all_blob_stores() {
  static const std::vector<BlobStoreUnderTest> stores = {
      {"Local",
       [](const std::filesystem::path& folder, int /*process*/) -> std::unique_ptr<BlobStore> {
         auto opened = open_blob_directory(folder);
         EXPECT_TRUE(opened) << opened.error().message;
         return opened ? std::move(*opened) : nullptr;
       },
       kOfFolders, folder_in_trouble},
      {"Shared",
       [](const std::filesystem::path& folder, int /*process*/) -> std::unique_ptr<BlobStore> {
         auto opened = open_shared_blob_directory(folder);
         EXPECT_TRUE(opened) << opened.error().message;
         return opened ? std::move(*opened) : nullptr;
       },
       kOfFolders, folder_in_trouble, true},
#ifdef DRIFTLAB_POSTGRES
      {"Postgres", open_database_blobs_under_test, kOfDatabases, database_in_trouble, true},
#endif
      {"ObjectStorage", open_object_blobs_under_test, kOfObjectStorages, object_storage_in_trouble, true,
       s3::ObjectStorage::is_installed},
  };
  return stores;
}

}  // namespace driftlab::server
