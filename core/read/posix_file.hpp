#pragma once
/// File descriptors that close themselves, and errno as an `Error`. Internal to core/read.
#include "core/signal/result.hpp"

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

namespace driftlab::posix {

/// An open file descriptor or -1. Closes on destruction.
class FileDescriptor {
 public:
  FileDescriptor() = default;
  explicit FileDescriptor(int fd) : fd_(fd) {}
  FileDescriptor(FileDescriptor&& other) noexcept : fd_(other.release()) {}
  FileDescriptor& operator=(FileDescriptor&& other) noexcept;
  FileDescriptor(const FileDescriptor&) = delete;
  FileDescriptor& operator=(const FileDescriptor&) = delete;
  ~FileDescriptor();

  [[nodiscard]] int get() const { return fd_; }
  [[nodiscard]] int release();

 private:
  int fd_ = -1;
};

/// "Cannot <action> the file '<file name>': <reason>." DiskFull for a full disk, quota or file-size limit, else Io.
/// Only the file name is shown: a service must not tell strangers where it keeps its data.
[[nodiscard]] Error io_error(int error_number, const std::string& action, const std::filesystem::path& path);

/// Opens for reading. Errors: NotFound, Io.
[[nodiscard]] Result<FileDescriptor> open_to_read(const std::filesystem::path& path);

/// Size of an open regular file. Error: Io, also for anything that is not a regular file.
[[nodiscard]] Result<std::size_t> regular_file_size(int fd, const std::filesystem::path& path);

/// Writes all of `bytes` at the file position. `path` is for the error.
[[nodiscard]] Status write_all(int fd, std::span<const std::byte> bytes, const std::filesystem::path& path);

/// Copies `count` bytes at `from_offset` of `from` to the file position of `to`, in the kernel where it can.
[[nodiscard]] Status copy_range(int from, std::size_t from_offset, int to, std::size_t count,
                                const std::filesystem::path& path);

}  // namespace driftlab::posix
