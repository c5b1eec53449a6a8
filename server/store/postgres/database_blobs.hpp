#pragma once
/// Blobs in a PostgreSQL database, in parts of 1 MiB, with copies in a local directory where jobs map them into memory.
///
/// The files of an upload are in the database before the upload is acknowledged. The path of a blob is that of the
/// local copy, which is fetched and compared with its checksum where it is absent; the copies that were used longest
/// ago are removed where they take more than their budget. So every daemon and worker reaches every recording with no
/// folder between them, at the price of a database as large as the recordings: base backups and pg_dump hold them too.
#include "server/store/blobs.hpp"
#include "server/store/sql/database.hpp"

#include <cstdint>
#include <memory>
#include <mutex>

namespace driftlab::server {

class DatabaseBlobs final : public BlobStore {
 public:
  /// `local` holds the copies; `root` is its directory. `database` must outlive this object.
  DatabaseBlobs(Database& database, std::unique_ptr<BlobStore> local, std::filesystem::path root,
                std::uintmax_t cache_bytes)
      : database_(database), local_(std::move(local)), root_(std::move(root)), cache_bytes_(cache_bytes) {}

  [[nodiscard]] Result<std::unique_ptr<IncomingBlob>> begin() override;
  [[nodiscard]] std::filesystem::path bytes_path(std::string_view sha256) const override;
  [[nodiscard]] std::filesystem::path columns_path(std::string_view sha256) const override;
  [[nodiscard]] Status remove(std::string_view sha256) override;
  [[nodiscard]] Result<bool> remove_if_older(std::string_view sha256, std::chrono::microseconds age) override;
  [[nodiscard]] Result<std::vector<std::string>> hashes_older_than(std::chrono::microseconds age) override;
  [[nodiscard]] Result<Space> space() const override { return local_->space(); }

  /// Writes the local files of a blob into the database, those that it does not hold as they are. Errors: Io, DiskFull.
  [[nodiscard]] Status store_files(const std::string& sha256);

 private:
  [[nodiscard]] Status store_file(const std::string& sha256, std::string_view kind, const std::filesystem::path& path);
  void fetch(const std::string& sha256, std::string_view kind, const std::filesystem::path& path) const;
  [[nodiscard]] Status fetch_into(const std::string& sha256, std::string_view kind,
                                  const std::filesystem::path& path) const;
  void make_room(const std::string& sha256) const;

  Database& database_;
  std::unique_ptr<BlobStore> local_;
  std::filesystem::path root_;
  std::uintmax_t cache_bytes_;
  mutable std::mutex fetching_;
};

}  // namespace driftlab::server
