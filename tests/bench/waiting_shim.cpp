// Work that waits instead of computing: loaded before a worker (LD_PRELOAD), by tests/bench/jobs_per_hour.py.
//
// DRIFTLAB_WAIT_FOR       every file whose name ends so is opened for reading only after a wait
// DRIFTLAB_WAIT_MS        of so many milliseconds
#include <dlfcn.h>
#include <fcntl.h>

#include <charconv>
#include <chrono>
#include <cstdarg>
#include <cstdlib>
#include <string_view>
#include <thread>

namespace {

std::string_view said(const char* name) {
  const char* const value = std::getenv(name);  // NOLINT(concurrency-mt-unsafe): never set
  return value == nullptr ? "" : value;
}

void wait_for(const char* path, int flags) {
  static const std::string_view ending = said("DRIFTLAB_WAIT_FOR");
  static const std::chrono::milliseconds wait = [] {
    const std::string_view text = said("DRIFTLAB_WAIT_MS");
    long milliseconds = 0;
    std::from_chars(text.data(), text.data() + text.size(), milliseconds);
    return std::chrono::milliseconds(milliseconds);
  }();
  if (!ending.empty() && (flags & O_ACCMODE) == O_RDONLY && std::string_view(path).ends_with(ending)) {
    std::this_thread::sleep_for(wait);
  }
}

}  // namespace

extern "C" int open(const char* path, int flags, ...) {
  using Real = int (*)(const char*, int, ...);
  static const auto real = reinterpret_cast<Real>(::dlsym(RTLD_NEXT, "open"));
  std::va_list more;
  va_start(more, flags);
  const int mode = (flags & (O_CREAT | O_TMPFILE)) != 0 ? va_arg(more, int) : 0;
  va_end(more);
  wait_for(path, flags);
  return real(path, flags, mode);
}

extern "C" int open64(const char* path, int flags, ...) {
  std::va_list more;
  va_start(more, flags);
  const int mode = (flags & (O_CREAT | O_TMPFILE)) != 0 ? va_arg(more, int) : 0;
  va_end(more);
  return open(path, flags, mode);
}
