#pragma once
/// Blobs: uploaded bytes and their decoded columns, as files in a folder; in other storages:
/// server/store/copied_blobs.hpp.
///
///   <root>/blobs/ab/abcdef...            the bytes as uploaded, named by their SHA-256
///   <root>/columns/ab/abcdef....columns  their decoded columns (core/read/column_file.hpp)
///   <root>/columns/ab/abcdef....columns.sha256  their checksum (server/store/checksums.hpp)
///   <root>/columns/ab/abcdef....columns.pyramid  of long columns: what traces show (core/read/trace_pyramid.hpp), made
///                                        again from the columns where it is missing; its checksum beside it
///   <root>/incoming/                     files being written; emptied when a daemon starts
///
/// A file appears under its final name complete or not at all: temporary file, fsync, rename, fsync of the directory. A
/// row in the store is written after the files; a file without a row is removed by the sweeper after 24 h.
#include "core/signal/result.hpp"
#include "server/store/clock.hpp"

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace driftlab::server {

/// An upload in progress: bytes go to disk and into the hash, memory stays flat. Dropped without `keep`: nothing is
/// left.
class IncomingBlob {
 public:
  IncomingBlob() = default;
  IncomingBlob(const IncomingBlob&) = delete;
  IncomingBlob& operator=(const IncomingBlob&) = delete;
  virtual ~IncomingBlob() = default;
  /// Errors: DiskFull, Io.
  [[nodiscard]] virtual Status append(std::span<const std::byte> bytes) = 0;
  /// Flushes to disk and closes the hash. Call once, before the members below.
  [[nodiscard]] virtual Status seal() = 0;
  [[nodiscard]] virtual const std::string& sha256() const = 0;
  [[nodiscard]] virtual std::size_t size() const = 0;
  /// The temporary file, for decoding before it is kept.
  [[nodiscard]] virtual const std::filesystem::path& path() const = 0;
  /// Where the decoded columns are to be written; `keep` moves them in place with the bytes, and a pyramid beside them.
  [[nodiscard]] virtual std::filesystem::path columns_path() const = 0;
  /// Moves bytes and columns to their final names, durably. Already there: there is one copy still, it counts as new
  /// again for the sweeper, success; columns need not be written again. Errors: DiskFull, Io; Internal where no columns
  /// were ever written.
  [[nodiscard]] virtual Status keep() = 0;
};

/// Where the pyramid of a columns file lies, whether there is one or not.
[[nodiscard]] std::filesystem::path pyramid_path(const std::filesystem::path& columns);

/// What of a blob somebody is about to use.
enum class BlobPart { Bytes, Columns };

class BlobStore {
 public:
  BlobStore() = default;
  BlobStore(const BlobStore&) = delete;
  BlobStore& operator=(const BlobStore&) = delete;
  virtual ~BlobStore() = default;
  [[nodiscard]] virtual Result<std::unique_ptr<IncomingBlob>> begin() = 0;
  [[nodiscard]] virtual std::filesystem::path bytes_path(std::string_view sha256) const = 0;
  [[nodiscard]] virtual std::filesystem::path columns_path(std::string_view sha256) const = 0;
  /// Removes the files of a blob. Absent: success.
  [[nodiscard]] virtual Status remove(std::string_view sha256) = 0;
  /// Removes both files if both are still older than `age`; true if removed. For the sweeper: a blob that is kept again
  /// meanwhile stays. Ages go by the clock that dates the files: that of another machine, where it keeps them, may be
  /// wrong by hours, and an upload under way would count as forgotten.
  [[nodiscard]] virtual Result<bool> remove_if_older(std::string_view sha256, std::chrono::microseconds age) = 0;
  /// Hashes of all blob files older than `age`. For the sweeper.
  [[nodiscard]] virtual Result<std::vector<std::string>> hashes_older_than(std::chrono::microseconds age) = 0;
  /// Free bytes on the file system, and the fraction that is free. For admission and /readyz.
  struct Space {
    std::uintmax_t free_bytes = 0;
    double free_fraction = 0.0;
  };
  [[nodiscard]] virtual Result<Space> space() const = 0;
  /// Brings a part of a blob to where its path leads, or finds that it is missing or damaged: then nothing is there, as
  /// checks of the file will say. Error: Io, where the storage does not answer, so that nobody knows; without this call
  /// that would look like a loss.
  [[nodiscard]] virtual Status reach(std::string_view /*sha256*/, BlobPart /*part*/) const { return {}; }
  /// Whether a storage that is no folder answers. Error: Io, in a sentence.
  [[nodiscard]] virtual Status ping() const { return {}; }
};

/// Where a directory of blobs keeps the bytes of one, and its columns.
[[nodiscard]] std::filesystem::path bytes_below(const std::filesystem::path& root, std::string_view sha256);
[[nodiscard]] std::filesystem::path columns_below(const std::filesystem::path& root, std::string_view sha256);

/// Blobs in a directory of the local file system, made if absent. Clears `incoming/`. Holds a lock on the directory
/// while it lives. Errors: Io; Conflict where another daemon has the directory.
[[nodiscard]] Result<std::unique_ptr<BlobStore>> open_blob_directory(const std::filesystem::path& root);

/// The same in a directory that several daemons and workers share, on this machine or on a network file system with
/// locks (flock). Uploads of a process that is gone are cleared; those of others stay. Errors: Io; Conflict where a
/// daemon has the directory alone.
[[nodiscard]] Result<std::unique_ptr<BlobStore>> open_shared_blob_directory(const std::filesystem::path& root);

}  // namespace driftlab::server
