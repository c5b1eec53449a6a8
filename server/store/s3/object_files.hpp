#pragma once
/// Files of recordings as objects of an S3-compatible storage, by the names that a folder has:
///
///   PREFIX/blobs/ab/abcdef...            the bytes as uploaded, named by their SHA-256
///   PREFIX/columns/ab/abcdef....columns  and .columns.sha256, .columns.pyramid, .columns.pyramid.sha256
///
/// so that another client of S3 reads them, and what it writes by these names is read. The SHA-256 of a file is the
/// object's metadata `sha256`; of bytes it is the name. A file larger than a part is uploaded in parts.
///
/// S3 has no lock and no delete under a condition. What is removed because it is old, and what an upload finds stored,
/// is therefore decided under a lock by the blob's hash (`names`) that all processes share: an upload looks, once its
/// objects are written, whether all of them are there, and writes again what was removed meanwhile.
#include "server/store/remote_files.hpp"
#include "server/store/s3/client.hpp"

namespace driftlab::server::s3 {

/// Runs `inside` while no other process does for the same blob. Errors: Io where there is no lock; those of `inside`.
using NamesLock = std::function<Status(const std::string& blob, const std::function<Status()>& inside)>;

class ObjectFiles final : public RemoteFiles {
 public:
  static constexpr std::size_t kPartBytes = 16U << 20U;

  /// `part_bytes`: a storage may want 5 MiB at least, and takes 10 000 parts. `page_keys`: of a listing at a time, 1000
  /// at most.
  ObjectFiles(Place place, Client::KeyRing keys, NamesLock names, ClientOptions options = {},
              std::size_t part_bytes = kPartBytes, int page_keys = 1000);

  [[nodiscard]] Status store(const std::string& blob, std::span<const LocalFile> files) override;
  [[nodiscard]] Result<std::string> read(const std::string& blob, FileKind kind, const Sink& sink) const override;
  [[nodiscard]] Status remove(const std::string& blob) override;
  [[nodiscard]] Result<bool> remove_if_older(const std::string& blob, std::chrono::microseconds age) override;
  /// Ends also uploads in parts that were begun before.
  [[nodiscard]] Result<std::vector<std::string>> hashes_older_than(std::chrono::microseconds age) override;
  [[nodiscard]] Status ping() const override;

  /// The word of the database that the objects belong to, `PREFIX/postgresql-store`; empty: there is none.
  [[nodiscard]] Result<std::string> mark() const;
  [[nodiscard]] Status write_mark(const std::string& word);
  /// Whether there is no object of a recording. One request.
  [[nodiscard]] Result<bool> is_empty() const;

 private:
  struct Written {
    std::string key;
    std::string sha256;
    std::uintmax_t bytes = 0;
  };
  [[nodiscard]] Result<Written> put_file(const std::string& key, const std::filesystem::path& path);
  [[nodiscard]] Status put_parts(const Written& written, const std::filesystem::path& path);
  [[nodiscard]] Status put_each_part(const std::string& key, const std::string& upload,
                                     const std::filesystem::path& path, std::uintmax_t bytes, std::string& parts);
  [[nodiscard]] Status complete(const Written& written, const std::string& upload, const std::string& parts);
  [[nodiscard]] Result<bool> holds(const Written& written) const;
  /// Calls `found` with the inside of each element `item` of a listing, and the storage's time. Errors: those of
  /// requests.
  [[nodiscard]] Status list(const std::string& folder,
                            const std::function<void(std::string_view item, UtcMicros now)>& found) const;
  [[nodiscard]] Status end_uploads_older_than(std::chrono::microseconds age);
  [[nodiscard]] std::string key_of(const std::string& blob, FileKind kind) const;

  Client client_;
  Client probe_;  ///< gives up soon
  NamesLock names_;
  std::size_t part_bytes_;
  std::string page_keys_;
};

}  // namespace driftlab::server::s3
