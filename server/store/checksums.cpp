#include "server/store/checksums.hpp"

#include "server/store/digest.hpp"
#include "server/store/files.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <vector>

namespace driftlab::server {

Result<std::string> sha256_of_file(const std::filesystem::path& path, const ReadingPace& pace) {
  constexpr std::size_t kPiece = std::size_t{1} << 20;
  const FileHandle file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (!file) {
    if (errno == ENOENT) {
      return fail(ErrorCode::NotFound, "There is no file '" + path.filename().string() + "'.");
    }
    return fail(file_error(errno, "open", path));
  }
  Sha256 digest;
  std::vector<std::byte> piece(kPiece);
  while (true) {
    const ssize_t count = ::read(file.get(), piece.data(), piece.size());
    if (count < 0 && errno != EINTR) {
      return fail(file_error(errno, "read", path));
    }
    if (count == 0) {
      break;
    }
    if (count > 0) {
      digest.update({piece.data(), static_cast<std::size_t>(count)});
      if (pace && !pace(static_cast<std::size_t>(count))) {
        return fail(ErrorCode::Cancelled, "The check was stopped.");
      }
    }
  }
  if (pace) {
    (void)::posix_fadvise(file.get(), 0, 0, POSIX_FADV_DONTNEED);
  }
  return digest.finish();
}

std::filesystem::path columns_checksum_path(const std::filesystem::path& columns) {
  std::filesystem::path path = columns;
  path += ".sha256";
  return path;
}

Status write_columns_checksum(const std::filesystem::path& columns) {
  const auto digest = sha256_of_file(columns);
  if (!digest) {
    return fail(digest.error());
  }
  const std::filesystem::path target = columns_checksum_path(columns);
  std::filesystem::path part = target;
  part += ".part";
  {
    const FileHandle file(::open(part.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600));
    if (!file || ::write(file.get(), digest->data(), digest->size()) != static_cast<ssize_t>(digest->size()) ||
        ::fsync(file.get()) != 0) {
      const Error error = file_error(errno, "write", part);
      (void)remove_file(part);
      return fail(error);
    }
  }
  return rename_durably(part, target);
}

Result<FileState> check_columns(const std::filesystem::path& columns, const ReadingPace& pace) {
  const auto digest = sha256_of_file(columns, pace);
  if (!digest) {
    return digest.error().code == ErrorCode::NotFound ? Result<FileState>(FileState::Missing) : fail(digest.error());
  }
  std::ifstream beside(columns_checksum_path(columns));
  std::string stated;
  if (!(beside >> stated)) {
    return FileState::Unknown;
  }
  return stated == *digest ? FileState::Sound : FileState::Damaged;
}

Result<FileState> check_bytes(const std::filesystem::path& bytes, std::string_view sha256, const ReadingPace& pace) {
  const auto digest = sha256_of_file(bytes, pace);
  if (!digest) {
    return digest.error().code == ErrorCode::NotFound ? Result<FileState>(FileState::Missing) : fail(digest.error());
  }
  return *digest == sha256 ? FileState::Sound : FileState::Damaged;
}

}  // namespace driftlab::server
