// A machine whose clock is wrong: loaded before the daemon (LD_PRELOAD), by tests/api/several_daemons_test.py.
//
// DRIFTLAB_CLOCK_AHEAD    seconds by which the calendar time of this process is ahead. Its steady clock is right.
#include <dlfcn.h>

#include <cstdlib>
#include <ctime>

namespace {

std::time_t seconds_ahead() {
  static const std::time_t ahead = [] {
    const char* const said = std::getenv("DRIFTLAB_CLOCK_AHEAD");  // NOLINT(concurrency-mt-unsafe): never set
    return said == nullptr ? 0 : static_cast<std::time_t>(std::strtoll(said, nullptr, 10));
  }();
  return ahead;
}

}  // namespace

extern "C" int clock_gettime(clockid_t clock, timespec* time) noexcept {
  using Real = int (*)(clockid_t, timespec*);
  static const auto real = reinterpret_cast<Real>(::dlsym(RTLD_NEXT, "clock_gettime"));
  const int failed = real(clock, time);
  if (failed == 0 && clock == CLOCK_REALTIME) {
    time->tv_sec += seconds_ahead();
  }
  return failed;
}
