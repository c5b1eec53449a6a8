#include "tests/unit/store/postgres/open_blobs.hpp"

#include "server/store/copied_blobs.hpp"
#include "server/store/postgres/database_files.hpp"
#include "server/store/postgres/postgres_store.hpp"
#include "tests/unit/store/postgres/cluster.hpp"
#include "tests/unit/store/postgres/open.hpp"

#include <gtest/gtest.h>

#include <csignal>

namespace driftlab::server {
namespace {

/// Files in the database of a store that they bring along.
class OwnedFiles final : public RemoteFiles {
 public:
  explicit OwnedFiles(std::unique_ptr<PostgresStore> store) : store_(std::move(store)), files_(store_->database()) {}
  [[nodiscard]] Status store(const std::string& blob, std::span<const LocalFile> files) override {
    return files_.store(blob, files);
  }
  [[nodiscard]] Result<std::string> read(const std::string& blob, FileKind kind, const Sink& sink) const override {
    return files_.read(blob, kind, sink);
  }
  [[nodiscard]] Status remove(const std::string& blob) override { return files_.remove(blob); }
  [[nodiscard]] Result<bool> remove_if_older(const std::string& blob, std::chrono::microseconds age) override {
    return files_.remove_if_older(blob, age);
  }
  [[nodiscard]] Result<std::vector<std::string>> hashes_older_than(std::chrono::microseconds age) override {
    return files_.hashes_older_than(age);
  }
  [[nodiscard]] Status ping() const override { return files_.ping(); }

 private:
  std::unique_ptr<PostgresStore> store_;
  DatabaseFiles files_;
};

}  // namespace

Trouble database_in_trouble(const std::filesystem::path& folder, BlobFault fault, const std::string& sha256) {
  PostgresCluster& cluster = PostgresCluster::of_this_process();
  const std::string schema = schema_for(folder);
  switch (fault) {
    case BlobFault::Cut:
      EXPECT_TRUE(cluster.cut_connections());
      break;
    case BlobFault::Unavailable:
      cluster.stop(SIGQUIT);
      return {&cluster, [](PostgresCluster* stopped) { stopped->start(); }};
    case BlobFault::Denied:
      EXPECT_TRUE(cluster.run("ALTER DATABASE postgres SET default_transaction_read_only = on"));
      EXPECT_TRUE(cluster.cut_connections());
      return {&cluster, [](PostgresCluster* denying) {
                EXPECT_TRUE(denying->run("ALTER DATABASE postgres RESET default_transaction_read_only"));
                EXPECT_TRUE(denying->cut_connections());
              }};
    case BlobFault::Damaged:
      EXPECT_TRUE(cluster.run("UPDATE " + schema +
                              ".stored_file_parts SET content = content || 'x' WHERE file_id IN "
                              "(SELECT id FROM " +
                              schema + ".stored_files WHERE blob = '" + sha256 +
                              "' AND kind IN ('bytes', 'columns'))"));
      break;
    case BlobFault::Missing:
      EXPECT_TRUE(cluster.run("DELETE FROM " + schema + ".stored_files WHERE blob = '" + sha256 +
                              "' AND kind IN ('bytes', 'columns')"));
      break;
    case BlobFault::Slow:
    case BlobFault::Full:
      ADD_FAILURE() << "a database has no such fault here";
      break;
  }
  return std::make_shared<int>(0);
}

std::unique_ptr<BlobStore> open_database_blobs_under_test(const std::filesystem::path& folder, int process) {
  auto store = open_postgres_store(PostgresCluster::of_this_process().schema(schema_for(folder)));
  EXPECT_TRUE(store) << store.error().message;
  const std::filesystem::path copies = folder / ("process" + std::to_string(process));
  auto local = open_blob_directory(copies);
  EXPECT_TRUE(local) << local.error().message;
  if (!store || !local) {
    return nullptr;
  }
  return std::make_unique<CopiedBlobs>(std::make_unique<OwnedFiles>(std::move(*store)), std::move(*local), copies,
                                       10'000,
                                       ReadPatience{3, std::chrono::milliseconds(50), std::chrono::seconds(30)});
}

}  // namespace driftlab::server
