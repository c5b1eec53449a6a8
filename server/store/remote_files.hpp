#pragma once
/// What a storage of recordings has to do that is no folder: a database, an object storage. CopiedBlobs makes blobs of
/// it.
///
/// A blob is up to five files there: its bytes, the decoded columns, the pyramid of long columns, and a checksum of
/// each of the latter two. Implementations are thread safe.
#include "core/signal/result.hpp"

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace driftlab::server {

/// `bytes`, `columns`, `columns.sha256`, `pyramid`, `pyramid.sha256`: the part of a name in front of a file.
using FileKind = std::string_view;
inline constexpr FileKind kBytes = "bytes";
inline constexpr FileKind kColumns = "columns";
inline constexpr FileKind kColumnsSum = "columns.sha256";
inline constexpr FileKind kPyramid = "pyramid";
inline constexpr FileKind kPyramidSum = "pyramid.sha256";

/// A file of a blob and its copy on this machine.
struct LocalFile {
  FileKind kind;
  std::filesystem::path path;
};

class RemoteFiles {
 public:
  /// Takes the next bytes of a file. What it fails with ends the reading.
  using Sink = std::function<Status(std::span<const std::byte>)>;

  RemoteFiles() = default;
  RemoteFiles(const RemoteFiles&) = delete;
  RemoteFiles& operator=(const RemoteFiles&) = delete;
  virtual ~RemoteFiles() = default;

  /// Writes these files of a blob durably, in their order and in place of equal ones that may be there, whole or
  /// damaged. Once it succeeds all of them are there and count as new for the sweeper. Errors: Io, DiskFull.
  [[nodiscard]] virtual Status store(const std::string& blob, std::span<const LocalFile> files) = 0;
  /// Reads a file. The result is the SHA-256 that its bytes have to have; empty where the storage does not know it.
  /// Errors: NotFound; Io, also where it broke off in the middle, so that the caller begins again; those of `sink`.
  [[nodiscard]] virtual Result<std::string> read(const std::string& blob, FileKind kind, const Sink& sink) const = 0;
  /// BlobStore::remove, BlobStore::remove_if_older, BlobStore::hashes_older_than.
  [[nodiscard]] virtual Status remove(const std::string& blob) = 0;
  [[nodiscard]] virtual Result<bool> remove_if_older(const std::string& blob, std::chrono::microseconds age) = 0;
  [[nodiscard]] virtual Result<std::vector<std::string>> hashes_older_than(std::chrono::microseconds age) = 0;
  /// Whether it can be reached, tried once and soon given up. Errors: Io.
  [[nodiscard]] virtual Status ping() const = 0;
};

}  // namespace driftlab::server
