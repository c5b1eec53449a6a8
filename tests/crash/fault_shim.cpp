// A disk that fails, and a power cut: loaded before the daemon (LD_PRELOAD), by tests/crash/disk.py.
//
// DRIFTLAB_FAULT_BELOW    only files below this directory are meant (absolute, without links)
// DRIFTLAB_FAULT_CONTROL  a file of Control, which the test maps too: it arms a fault while the daemon runs
// DRIFTLAB_FAULT_SHADOW   a directory: what is on disk for certain is kept there, for a power cut to go back to
//
// For certain is what the strictest file system keeps: the content of a file as it was at its last fsync, and the names
// in a directory as they were at that directory's last fsync. A file or a directory is told by its inode and the time
// of its birth, for inodes are used again. Everything else that was written is lost.
#include <dirent.h>
#include <dlfcn.h>
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/uio.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <climits>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

namespace {

enum class Kind : std::int64_t { None = 0, Read = 1, Write = 2, Sync = 3, Rename = 4 };

/// Eight bytes each, in the order of the machine.
struct Control {
  std::atomic<std::int64_t> kind;    // which calls fail
  std::atomic<std::int64_t> passes;  // so many pass before
  std::atomic<std::int64_t> error;   // errno of those that fail
  std::atomic<std::int64_t> fails;   // so many fail
  std::atomic<std::int64_t> failed;  // have failed since it was armed
};
static_assert(sizeof(Control) == 40);

template <class Function>
Function real(const char* name) {
  return reinterpret_cast<Function>(::dlsym(RTLD_NEXT, name));
}

/// A variable of the environment, empty where it is not set. The daemon never sets one.
std::string said(const char* name) {
  const char* const value = std::getenv(name);  // NOLINT(concurrency-mt-unsafe)
  return value == nullptr ? "" : value;
}

/// A folder that the environment names, with the slash behind it; empty where it names none.
std::string folder_said(const char* name) {
  const std::string folder = said(name);
  return folder.empty() ? folder : folder + "/";
}

/// What the environment says, read once.
struct World {
  World() : below(folder_said("DRIFTLAB_FAULT_BELOW")), shadow(folder_said("DRIFTLAB_FAULT_SHADOW")) {
    if (const std::string file = said("DRIFTLAB_FAULT_CONTROL"); !file.empty()) {
      const int descriptor = ::open(file.c_str(), O_RDWR | O_CLOEXEC);
      void* const mapped = ::mmap(nullptr, sizeof(Control), PROT_READ | PROT_WRITE, MAP_SHARED, descriptor, 0);
      control = mapped == MAP_FAILED ? nullptr : static_cast<Control*>(mapped);
      (void)::close(descriptor);
    }
  }
  std::string below, shadow;
  Control* control = nullptr;
};

const World& world() {
  static const World only;
  return only;
}

bool is_below(const char* path) {
  const std::string& below = world().below;
  return !below.empty() && std::strncmp(path, below.c_str(), below.size()) == 0;
}

/// Whether the descriptor is of a file below the directory, or of the directory itself.
bool is_below(int descriptor) {
  std::array<char, 64> link{};
  (void)std::snprintf(link.data(), link.size(), "/proc/self/fd/%d", descriptor);
  std::array<char, PATH_MAX> target{};
  const ssize_t length = ::readlink(link.data(), target.data(), target.size() - 2);
  if (length <= 0) {
    return false;
  }
  target.at(static_cast<std::size_t>(length)) = '/';
  return is_below(target.data());
}

/// Whether this call is one that fails; errno is set then. `is_meant` is asked only where a fault of its kind is armed.
template <class IsMeant>
bool fails(Kind kind, IsMeant is_meant) {
  Control* const control = world().control;
  if (control == nullptr || control->kind != static_cast<std::int64_t>(kind) || !is_meant()) {
    return false;
  }
  if (control->passes.fetch_sub(1) > 0 || control->fails.fetch_sub(1) <= 0) {
    return false;
  }
  ++control->failed;
  errno = static_cast<int>(control->error.load());
  return true;
}

/// What tells a file from every other that ever was there.
std::string identity(const struct ::statx& found) {
  return std::to_string(found.stx_ino) + "-" + std::to_string(found.stx_btime.tv_sec) + "-" +
         std::to_string(found.stx_btime.tv_nsec);
}

bool examine(int folder, const char* name, struct ::statx& found) {
  return ::statx(folder, name, AT_EMPTY_PATH | AT_SYMLINK_NOFOLLOW, STATX_BTIME | STATX_INO | STATX_TYPE, &found) == 0;
}

/// Puts a whole file in the place of another at once: a kill leaves one or the other.
class Replacement {
 public:
  explicit Replacement(std::string target) : target_(std::move(target)) {
    static std::atomic<std::uint64_t> number{0};
    part_ = target_ + ".part" + std::to_string(number.fetch_add(1));
    descriptor_ = ::open(part_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
  }
  void add(const char* bytes, std::size_t size) {
    static const auto write_now = real<ssize_t (*)(int, const void*, std::size_t)>("write");
    while (size > 0) {
      const ssize_t written = write_now(descriptor_, bytes, size);
      if (written <= 0) {
        std::abort();  // the test's own disk is full: nothing it says would be worth anything
      }
      bytes += written;
      size -= static_cast<std::size_t>(written);
    }
  }
  void finish() {
    static const auto rename_now = real<int (*)(const char*, const char*)>("rename");
    (void)::close(descriptor_);
    (void)rename_now(part_.c_str(), target_.c_str());
  }

 private:
  std::string target_, part_;
  int descriptor_ = -1;
};

/// Keeps the content of a file, or the names in a directory, as they are now.
void keep(int descriptor) {
  struct ::statx found{};
  if (!examine(descriptor, "", found)) {
    return;
  }
  Replacement kept(world().shadow + identity(found));
  if (S_ISDIR(found.stx_mode)) {
    const int copy = ::openat(descriptor, ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    DIR* const folder = ::fdopendir(copy);
    // NOLINTNEXTLINE(concurrency-mt-unsafe): one thread has this folder
    for (const dirent* entry = ::readdir(folder); entry != nullptr; entry = ::readdir(folder)) {
      struct ::statx named{};
      const std::string name(static_cast<const char*>(entry->d_name));
      if (name != "." && name != ".." && examine(copy, name.c_str(), named)) {
        const std::string line = (S_ISDIR(named.stx_mode) ? "d " : "f ") + identity(named) + " " + name + "\n";
        kept.add(line.data(), line.size());
      }
    }
    (void)::closedir(folder);
  } else {
    static const auto pread_now = real<ssize_t (*)(int, void*, std::size_t, off_t)>("pread64");
    // The file may be open for writing alone.
    const std::string link = "/proc/self/fd/" + std::to_string(descriptor);
    const int reading = ::open(link.c_str(), O_RDONLY | O_CLOEXEC);
    std::array<char, 65536> piece{};
    off_t at = 0;
    for (ssize_t got = 0; (got = pread_now(reading, piece.data(), piece.size(), at)) > 0; at += got) {
      kept.add(piece.data(), static_cast<std::size_t>(got));
    }
    (void)::close(reading);
  }
  kept.finish();
}

int sync_now(int descriptor, int (*sync)(int)) {
  if (fails(Kind::Sync, [descriptor] { return is_below(descriptor); })) {
    return -1;
  }
  // No need to reach the disk below: the machine stays on.
  if (!world().shadow.empty() && is_below(descriptor)) {
    keep(descriptor);
    return 0;
  }
  return sync(descriptor);
}

}  // namespace

extern "C" {

ssize_t read(int descriptor, void* into, std::size_t size) {
  static const auto next = real<ssize_t (*)(int, void*, std::size_t)>("read");
  return fails(Kind::Read, [descriptor] { return is_below(descriptor); }) ? -1 : next(descriptor, into, size);
}

ssize_t pread(int descriptor, void* into, std::size_t size, off_t at) {
  static const auto next = real<ssize_t (*)(int, void*, std::size_t, off_t)>("pread64");
  return fails(Kind::Read, [descriptor] { return is_below(descriptor); }) ? -1 : next(descriptor, into, size, at);
}

ssize_t pread64(int descriptor, void* into, std::size_t size, off64_t at) { return pread(descriptor, into, size, at); }

ssize_t write(int descriptor, const void* from, std::size_t size) {
  static const auto next = real<ssize_t (*)(int, const void*, std::size_t)>("write");
  return fails(Kind::Write, [descriptor] { return is_below(descriptor); }) ? -1 : next(descriptor, from, size);
}

ssize_t writev(int descriptor, const iovec* from, int count) {
  static const auto next = real<ssize_t (*)(int, const iovec*, int)>("writev");
  return fails(Kind::Write, [descriptor] { return is_below(descriptor); }) ? -1 : next(descriptor, from, count);
}

ssize_t pwrite(int descriptor, const void* from, std::size_t size, off_t at) {
  static const auto next = real<ssize_t (*)(int, const void*, std::size_t, off_t)>("pwrite64");
  return fails(Kind::Write, [descriptor] { return is_below(descriptor); }) ? -1 : next(descriptor, from, size, at);
}

ssize_t pwrite64(int descriptor, const void* from, std::size_t size, off64_t at) {
  return pwrite(descriptor, from, size, at);
}

int fsync(int descriptor) {
  static const auto next = real<int (*)(int)>("fsync");
  return sync_now(descriptor, next);
}

int fdatasync(int descriptor) {
  static const auto next = real<int (*)(int)>("fdatasync");
  return sync_now(descriptor, next);
}

int rename(const char* from, const char* to) noexcept {
  static const auto next = real<int (*)(const char*, const char*)>("rename");
  return fails(Kind::Rename, [to] { return is_below(to); }) ? -1 : next(from, to);
}

}  // extern "C"
