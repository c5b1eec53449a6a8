#include "server/store/files.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/vfs.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <string>
#include <system_error>

namespace driftlab::server {

FileHandle::~FileHandle() {
  if (descriptor_ >= 0) {
    (void)::close(descriptor_);
  }
}

Error file_error(int error_number, std::string_view doing, const std::filesystem::path& path) {
  const bool full = error_number == ENOSPC || error_number == EDQUOT || error_number == EFBIG;
  const std::string reason = std::generic_category().message(error_number);
  return Error{full ? ErrorCode::DiskFull : ErrorCode::Io,
               "Could not " + std::string(doing) + " " + path.string() + ": " + reason + ".",
               {{"path", path.string()}}};
}

bool is_there(const std::filesystem::path& path) {
  std::error_code none;
  return std::filesystem::exists(path, none);
}

Status make_directories(const std::filesystem::path& path) {
  struct ::stat found{};
  if (::stat(path.c_str(), &found) == 0) {
    return S_ISDIR(found.st_mode) ? Status{} : fail(file_error(ENOTDIR, "use", path));
  }
  const std::filesystem::path parent = path.parent_path();
  if (!parent.empty() && parent != path) {
    if (Status made = make_directories(parent); !made) {
      return made;
    }
  }
  if (::mkdir(path.c_str(), 0700) != 0 && errno != EEXIST) {
    return fail(file_error(errno, "make the directory", path));
  }
  return sync_path(parent.empty() ? std::filesystem::path(".") : parent);
}

Status sync_path(const std::filesystem::path& path) {
  const FileHandle file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (!file) {
    return fail(file_error(errno, "open", path));
  }
  if (::fsync(file.get()) != 0) {
    return fail(file_error(errno, "flush", path));
  }
  return {};
}

Status rename_durably(const std::filesystem::path& from, const std::filesystem::path& to) {
  if (::rename(from.c_str(), to.c_str()) != 0) {
    return fail(file_error(errno, "rename a file to", to));
  }
  return sync_path(to.parent_path());
}

Status write_secret_file(const std::filesystem::path& path, std::string_view text) {
  const std::filesystem::path temporary = path.string() + ".new";
  if (Status removed = remove_file(temporary); !removed) {
    return removed;
  }
  {
    const FileHandle file(::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0600));
    if (!file) {
      return fail(file_error(errno, "make", temporary));
    }
    if (::write(file.get(), text.data(), text.size()) != static_cast<ssize_t>(text.size()) ||
        ::fsync(file.get()) != 0) {
      return fail(file_error(errno, "write", temporary));
    }
  }
  return rename_durably(temporary, path);
}

Status remove_file(const std::filesystem::path& path) {
  if (::unlink(path.c_str()) != 0 && errno != ENOENT) {
    return fail(file_error(errno, "remove", path));
  }
  return {};
}

Result<FileHandle> lock_directory(const std::filesystem::path& directory, std::string_view name) {
  const std::filesystem::path path = directory / name;
  FileHandle file(::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600));
  if (!file) {
    return fail(file_error(errno, "open the lock file", path));
  }
  if (::flock(file.get(), LOCK_EX | LOCK_NB) != 0) {
    if (errno != EWOULDBLOCK) {
      return fail(file_error(errno, "lock", path));
    }
    std::array<char, 32> text{};
    const ssize_t length = ::pread(file.get(), text.data(), text.size(), 0);
    const std::string holder(text.data(), static_cast<std::size_t>(std::max<ssize_t>(length, 0)));
    return fail(ErrorCode::Conflict,
                "Another driftlab daemon (process " + holder + ") uses the directory " + directory.string() +
                    "; one daemon at a time can.",
                {{"path", directory.string()}, {"process", holder}});
  }
  const std::string self = std::to_string(::getpid());
  if (::ftruncate(file.get(), 0) != 0 || ::pwrite(file.get(), self.data(), self.size(), 0) < 0) {
    return fail(file_error(errno, "write", path));
  }
  return file;
}

bool is_network_file_system(long type) {
  // statfs(2): NFS, SMB, CIFS, SMB2, AFS (two), Coda, Ceph, 9P, Lustre, GFS2, OCFS2, NCP, GPFS.
  constexpr std::array<unsigned long, 14> kShared = {0x6969,     0x517B,     0xFF534D42, 0xFE534D42, 0x5346414F,
                                                     0x6B414653, 0x73757245, 0x00C36400, 0x01021997, 0x0BD00BD0,
                                                     0x01161970, 0x7461636F, 0x564C,     0x47504653};
  return std::find(kShared.begin(), kShared.end(), static_cast<unsigned long>(type) & 0xFFFFFFFFUL) != kShared.end();
}

Status require_local_file_system(const std::filesystem::path& directory) {
  struct ::statfs found{};
  if (::statfs(directory.c_str(), &found) != 0) {
    return fail(file_error(errno, "examine the file system of", directory));
  }
  if (is_network_file_system(static_cast<long>(found.f_type))) {
    return fail(ErrorCode::Io,
                "The directory " + directory.string() +
                    " lies on a network file system, where the database's locks and shared memory do not hold; "
                    "choose a local disk.",
                {{"path", directory.string()}});
  }
  return {};
}

}  // namespace driftlab::server
