#include "tests/unit/store/postgres/open_blobs.hpp"

#include "server/store/postgres/database_blobs.hpp"
#include "server/store/postgres/postgres_store.hpp"
#include "tests/unit/store/postgres/cluster.hpp"
#include "tests/unit/store/postgres/open.hpp"

#include <gtest/gtest.h>

namespace driftlab::server {
namespace {

/// Blobs with the store whose database they lie in.
class OwnedBlobs final : public BlobStore {
 public:
  OwnedBlobs(std::unique_ptr<PostgresStore> store, std::unique_ptr<BlobStore> local, const std::filesystem::path& root)
      : store_(std::move(store)), blobs_(store_->database(), std::move(local), root, 10'000) {}
  [[nodiscard]] Result<std::unique_ptr<IncomingBlob>> begin() override { return blobs_.begin(); }
  [[nodiscard]] std::filesystem::path bytes_path(std::string_view sha256) const override {
    return blobs_.bytes_path(sha256);
  }
  [[nodiscard]] std::filesystem::path columns_path(std::string_view sha256) const override {
    return blobs_.columns_path(sha256);
  }
  [[nodiscard]] Status remove(std::string_view sha256) override { return blobs_.remove(sha256); }
  [[nodiscard]] Result<bool> remove_if_older(std::string_view sha256, std::chrono::microseconds age) override {
    return blobs_.remove_if_older(sha256, age);
  }
  [[nodiscard]] Result<std::vector<std::string>> hashes_older_than(std::chrono::microseconds age) override {
    return blobs_.hashes_older_than(age);
  }
  [[nodiscard]] Result<Space> space() const override { return blobs_.space(); }

 private:
  std::unique_ptr<PostgresStore> store_;
  DatabaseBlobs blobs_;
};

}  // namespace

std::unique_ptr<BlobStore> open_database_blobs_under_test(const std::filesystem::path& folder, int process) {
  auto store = open_postgres_store(PostgresCluster::of_this_process().schema(schema_for(folder)));
  EXPECT_TRUE(store) << store.error().message;
  const std::filesystem::path copies = folder / ("process" + std::to_string(process));
  auto local = open_blob_directory(copies);
  EXPECT_TRUE(local) << local.error().message;
  return store && local ? std::make_unique<OwnedBlobs>(std::move(*store), std::move(*local), copies) : nullptr;
}

}  // namespace driftlab::server
