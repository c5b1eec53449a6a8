#include "tests/unit/store/small_disk.hpp"

#include "tests/unit/store/world.hpp"

#include <sched.h>
#include <sys/mount.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>

namespace driftlab::server {
namespace {

/// The child's part.
std::string mount_and_run(std::size_t bytes, const std::filesystem::path& directory,
                          const std::function<std::string(const std::filesystem::path&)>& body) {
  if (::unshare(CLONE_NEWNS) != 0 && ::unshare(CLONE_NEWUSER | CLONE_NEWNS) != 0) {
    return "skip: no mount namespace";
  }
  const std::string options = "size=" + std::to_string(bytes);
  if (::mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) != 0 ||
      ::mount("tmpfs", directory.c_str(), "tmpfs", 0, options.c_str()) != 0) {
    return "skip: no tmpfs";
  }
  return body(directory);
}

}  // namespace

std::string on_small_disk(std::size_t bytes, const std::function<std::string(const std::filesystem::path&)>& body) {
  const TemporaryDirectory directory;
  std::array<int, 2> ends{};
  if (::pipe(ends.data()) != 0) {
    return "no pipe";
  }
  const pid_t child = ::fork();
  if (child == 0) {
    const std::string said = "ended:" + mount_and_run(bytes, directory.path(), body);
    (void)!::write(ends[1], said.data(), said.size());
    ::_exit(0);
  }
  (void)::close(ends[1]);
  std::string said;
  std::array<char, 512> buffer{};
  for (ssize_t got = 0; (got = ::read(ends[0], buffer.data(), buffer.size())) > 0;) {
    said.append(buffer.data(), static_cast<std::size_t>(got));
  }
  (void)::close(ends[0]);
  int status = 0;
  (void)::waitpid(child, &status, 0);
  constexpr std::string_view kEnded = "ended:";
  return said.starts_with(kEnded) ? said.substr(kEnded.size()) : "the child died with status " + std::to_string(status);
}

}  // namespace driftlab::server
