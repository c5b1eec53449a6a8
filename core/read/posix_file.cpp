#include "core/read/posix_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <system_error>
#include <utility>
#include <vector>

namespace driftlab::posix {

FileDescriptor& FileDescriptor::operator=(FileDescriptor&& other) noexcept {
  if (this != &other) {
    if (fd_ >= 0) {
      ::close(fd_);
    }
    fd_ = other.release();
  }
  return *this;
}

FileDescriptor::~FileDescriptor() {
  if (fd_ >= 0) {
    ::close(fd_);
  }
}

int FileDescriptor::release() { return std::exchange(fd_, -1); }

Error io_error(int error_number, const std::string& action, const std::filesystem::path& path) {
  const std::string name = path.filename().string();
  ErrorCode code = ErrorCode::Io;
  if (error_number == ENOSPC || error_number == EDQUOT || error_number == EFBIG) {
    code = ErrorCode::DiskFull;
  }
  return Error{code,
               "Cannot " + action + " the file '" + name + "': " + std::generic_category().message(error_number) + ".",
               {{"path", name}}};
}

Result<FileDescriptor> open_to_read(const std::filesystem::path& path) {
  FileDescriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOCTTY));
  if (file.get() < 0) {
    const bool missing = errno == ENOENT;
    Error error = io_error(errno, "open", path);
    error.code = missing ? ErrorCode::NotFound : error.code;
    return fail(std::move(error));
  }
  return file;
}

Result<std::size_t> regular_file_size(int fd, const std::filesystem::path& path) {
  struct stat status{};
  if (::fstat(fd, &status) != 0) {
    return fail(io_error(errno, "inspect", path));
  }
  if (!S_ISREG(status.st_mode)) {
    return fail(io_error(S_ISDIR(status.st_mode) ? EISDIR : EINVAL, "read", path));
  }
  return static_cast<std::size_t>(status.st_size);
}

Status write_all(int fd, std::span<const std::byte> bytes, const std::filesystem::path& path) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(fd, bytes.data(), bytes.size());
    if (written < 0) {
      if (errno == EINTR) {
        continue;
      }
      return fail(io_error(errno, "write", path));
    }
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
  return {};
}

namespace {

/// For file systems without copy_file_range.
Status copy_by_hand(int from, std::size_t from_offset, int to, std::size_t count, const std::filesystem::path& path) {
  std::vector<std::byte> buffer(std::min<std::size_t>(count, 1U << 20));
  while (count > 0) {
    const ssize_t got = ::pread(from, buffer.data(), std::min(count, buffer.size()), static_cast<off_t>(from_offset));
    if (got < 0 && errno == EINTR) {
      continue;
    }
    if (got <= 0) {
      return fail(io_error(got < 0 ? errno : EIO, "read back", path));
    }
    const auto bytes = static_cast<std::size_t>(got);
    if (auto status = write_all(to, {buffer.data(), bytes}, path); !status) {
      return status;
    }
    from_offset += bytes;
    count -= bytes;
  }
  return {};
}

}  // namespace

Status copy_range(int from, std::size_t from_offset, int to, std::size_t count, const std::filesystem::path& path) {
  auto position = static_cast<off_t>(from_offset);
  while (count > 0) {
    const ssize_t copied = ::copy_file_range(from, &position, to, nullptr, count, 0);
    if (copied > 0) {
      count -= static_cast<std::size_t>(copied);
    } else if (copied < 0 && errno == EINTR) {
      continue;
    } else if (copied == 0 || errno == ENOSYS || errno == EXDEV || errno == EINVAL || errno == EOPNOTSUPP) {
      return copy_by_hand(from, static_cast<std::size_t>(position), to, count, path);
    } else {
      return fail(io_error(errno, "write", path));
    }
  }
  return {};
}

}  // namespace driftlab::posix
