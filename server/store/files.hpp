#pragma once
/// The few system calls that durability rests on, with their errors as sentences.
#include "core/signal/result.hpp"

#include <filesystem>
#include <string_view>
#include <utility>

namespace driftlab::server {

/// A file descriptor that closes itself.
class FileHandle {
 public:
  FileHandle() = default;
  explicit FileHandle(int descriptor) : descriptor_(descriptor) {}
  FileHandle(const FileHandle&) = delete;
  FileHandle& operator=(const FileHandle&) = delete;
  FileHandle(FileHandle&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}
  FileHandle& operator=(FileHandle&& other) noexcept {
    std::swap(descriptor_, other.descriptor_);
    return *this;
  }
  ~FileHandle();
  [[nodiscard]] int get() const { return descriptor_; }
  [[nodiscard]] explicit operator bool() const { return descriptor_ >= 0; }

 private:
  int descriptor_ = -1;
};

/// What `errno` = `error_number` means for `path`: DiskFull for a full disk, an exceeded quota or file-size limit, else
/// Io.
[[nodiscard]] Error file_error(int error_number, std::string_view doing, const std::filesystem::path& path);

/// Whether there is something at the path, of any kind; false where nobody can say.
[[nodiscard]] bool is_there(const std::filesystem::path& path);

/// Makes the directory and its parents (mode 0700), durably. Errors: Io, DiskFull.
[[nodiscard]] Status make_directories(const std::filesystem::path& path);

/// Flushes a file or a directory to disk. Errors: Io, DiskFull.
[[nodiscard]] Status sync_path(const std::filesystem::path& path);

/// Writes a file that only its owner can read (mode 0600), durably. An existing one is replaced. Errors: Io, DiskFull.
[[nodiscard]] Status write_secret_file(const std::filesystem::path& path, std::string_view text);

/// Renames within one file system and flushes the target's directory. An existing target is replaced.
[[nodiscard]] Status rename_durably(const std::filesystem::path& from, const std::filesystem::path& to);

/// Removes a file. Absent: success.
[[nodiscard]] Status remove_file(const std::filesystem::path& path);

/// Takes `directory/name` as a lock for this object's life: one daemon for one directory. The kernel drops it when the
/// process dies. Errors: Conflict, naming the holder's process; Io.
[[nodiscard]] Result<FileHandle> lock_directory(const std::filesystem::path& directory, std::string_view name);

/// True for a file-system type (statfs f_type) that several machines can share: shared memory and locks do not hold
/// there.
[[nodiscard]] bool is_network_file_system(long type);

/// Errors: Io, where `directory` lies on a network file system, or cannot be examined.
[[nodiscard]] Status require_local_file_system(const std::filesystem::path& directory);

}  // namespace driftlab::server
