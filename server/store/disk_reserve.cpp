#include "server/store/disk_reserve.hpp"

#include "server/store/files.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>

namespace driftlab::server {

Status DiskReserve::hold() {
  const std::lock_guard<std::mutex> guard(mutex_);
  struct ::stat found{};
  if (bytes_ == 0 || (::stat(file_.c_str(), &found) == 0 && found.st_size >= bytes_)) {
    return {};
  }
  const FileHandle file(::open(file_.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0600));
  if (!file) {
    return fail(file_error(errno, "make", file_));
  }
  if (const int refused = ::posix_fallocate(file.get(), 0, bytes_); refused != 0) {
    (void)::unlink(file_.c_str());
    return fail(file_error(refused, "reserve space in", file_));
  }
  return {};
}

bool DiskReserve::release() {
  const std::lock_guard<std::mutex> guard(mutex_);
  return ::unlink(file_.c_str()) == 0;
}

}  // namespace driftlab::server
