#pragma once
/// Blobs in a storage that is no folder (server/store/remote_files.hpp), with copies in a local directory where jobs
/// map them into memory.
///
/// The files of an upload are in the storage before the upload is acknowledged. The path of a blob is that of the local
/// copy, which is fetched and compared with its checksum where it is absent; the copies that were used longest ago are
/// removed where they take more than their budget. So every daemon and worker reaches every recording with no folder
/// between them.
#include "server/store/blobs.hpp"
#include "server/store/remote_files.hpp"

#include <array>
#include <cstdint>
#include <memory>
#include <mutex>

namespace driftlab::server {

/// How often a file is asked for again that could not be read, and for how long at most.
struct ReadPatience {
  int attempts = 5;
  std::chrono::milliseconds first_pause{500};  ///< doubled each time; drawn between nothing and that
  std::chrono::seconds in_all{30};
};

class CopiedBlobs final : public BlobStore {
 public:
  /// `local` holds the copies; `root` is its directory.
  CopiedBlobs(std::unique_ptr<RemoteFiles> remote, std::unique_ptr<BlobStore> local, std::filesystem::path root,
              std::uintmax_t cache_bytes, ReadPatience patience = {})
      : remote_(std::move(remote)),
        local_(std::move(local)),
        root_(std::move(root)),
        cache_bytes_(cache_bytes),
        patience_(patience) {}

  [[nodiscard]] Result<std::unique_ptr<IncomingBlob>> begin() override;
  [[nodiscard]] std::filesystem::path bytes_path(std::string_view sha256) const override;
  [[nodiscard]] std::filesystem::path columns_path(std::string_view sha256) const override;
  [[nodiscard]] Status reach(std::string_view sha256, BlobPart part) const override;
  [[nodiscard]] Status ping() const override { return remote_->ping(); }
  [[nodiscard]] Status remove(std::string_view sha256) override;
  [[nodiscard]] Result<bool> remove_if_older(std::string_view sha256, std::chrono::microseconds age) override;
  [[nodiscard]] Result<std::vector<std::string>> hashes_older_than(std::chrono::microseconds age) override {
    return remote_->hashes_older_than(age);
  }
  [[nodiscard]] Result<Space> space() const override { return local_->space(); }

  /// Writes the local files of a blob into the storage. Errors: Io, DiskFull.
  [[nodiscard]] Status store_files(const std::string& sha256);

 private:
  enum class Fetched { There, Missing, Damaged };

  [[nodiscard]] Result<Fetched> fetch(const std::string& sha256, FileKind kind,
                                      const std::filesystem::path& path) const;
  [[nodiscard]] Result<Fetched> fetch_once(const std::string& sha256, FileKind kind,
                                           const std::filesystem::path& path) const;
  void make_room(const std::string& sha256) const;

  std::unique_ptr<RemoteFiles> remote_;
  std::unique_ptr<BlobStore> local_;
  std::filesystem::path root_;
  std::uintmax_t cache_bytes_;
  ReadPatience patience_;
  /// One file is fetched once at a time; others beside it.
  mutable std::array<std::mutex, 16> fetching_;
  mutable std::mutex making_room_;
};

}  // namespace driftlab::server
