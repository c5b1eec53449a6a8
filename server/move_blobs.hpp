#pragma once
/// Copies recordings from one place to another, whole or not at all, each compared with its checksums at both ends.
#include "core/signal/result.hpp"
#include "server/store/blobs.hpp"

#include <filesystem>
#include <functional>
#include <set>
#include <string>
#include <vector>

namespace driftlab::server {

/// Where the files of a recording lie, by its hash.
struct BlobFiles {
  std::function<std::filesystem::path(const std::string& sha256)> bytes;
  std::function<std::filesystem::path(const std::string& sha256)> columns;
};

/// Those of a store, which must outlive it.
[[nodiscard]] BlobFiles files_of(const BlobStore& blobs);
/// Those of a directory that a daemon may be using: a recording appears there whole and never changes.
[[nodiscard]] BlobFiles files_in(const std::filesystem::path& root);
/// Hashes of all recordings in such a directory. Error: Io.
[[nodiscard]] Result<std::vector<std::string>> hashes_in(const std::filesystem::path& root);

/// Whether bytes and columns are there and what was written.
[[nodiscard]] bool is_sound(const BlobFiles& files, const std::string& sha256);

/// Errors: Io (damaged where it is; not copied as it is); those of the files and of the store.
[[nodiscard]] Status copy_blob(const BlobFiles& from, BlobStore& to, const std::string& sha256);

/// What a target has already, as a file remembers it: its first line says of which move, the others name recordings.
/// With the first line alone the move has begun, and the target may hold rows.
class AheadList {
 public:
  /// What a file at `path` holds of the move `what`; nothing where it is of another one.
  AheadList(std::filesystem::path path, std::string what);
  /// Whether something was begun to be copied by that move.
  [[nodiscard]] bool is_begun() const { return begun_; }
  /// Makes the file, if it is not of this move. Errors: Io; DiskFull.
  [[nodiscard]] Status begin();
  [[nodiscard]] bool holds(const std::string& sha256) const { return hashes_.contains(sha256); }
  /// Keeps only what is in `there`.
  void keep(const std::vector<std::string>& there);
  /// Errors: Io; DiskFull.
  [[nodiscard]] Status add(const std::string& sha256);
  /// Error: Io.
  [[nodiscard]] Status remove();

 private:
  std::filesystem::path path_;
  std::string what_;
  std::set<std::string> hashes_;
  bool begun_ = false;  ///< the file is of this move
};

}  // namespace driftlab::server
