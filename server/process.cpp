#include "server/process.hpp"

#include <fcntl.h>
#include <pthread.h>
#include <unistd.h>

#include <csignal>
#include <ctime>
#include <fstream>
#include <thread>

namespace driftlab::server {

void occupy_standard_descriptors() {
  for (int descriptor = 0; descriptor <= 2; ++descriptor) {
    if (::fcntl(descriptor, F_GETFD) < 0) {
      // The lowest number that is free is this one.
      (void)::open("/dev/null", descriptor == 0 ? O_RDONLY : O_WRONLY);
    }
  }
}

ProcessUse use_of_this_process() {
  ProcessUse use;
  std::ifstream pages("/proc/self/statm");
  double total = 0.0;
  double resident = 0.0;
  if (pages >> total >> resident) {
    use.resident_bytes = resident * static_cast<double>(::sysconf(_SC_PAGESIZE));
  }
  timespec spent{};
  if (::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &spent) == 0) {
    use.cpu_seconds = static_cast<double>(spent.tv_sec) + 1e-9 * static_cast<double>(spent.tv_nsec);
  }
  return use;
}

Signals::Signals() {
  sigemptyset(&waited_for_);
  for (const int signal : {SIGTERM, SIGINT, SIGHUP}) {
    sigaddset(&waited_for_, signal);
  }
  pthread_sigmask(SIG_BLOCK, &waited_for_, nullptr);
  for (const int signal : {SIGPIPE, SIGXFSZ}) {
    std::signal(signal, SIG_IGN);  // NOLINT(cert-err33-c): SIG_IGN is always accepted for these
  }
}

void Signals::wait_for_stop(const std::function<void()>& reload) {
  int signal = SIGHUP;
  while (signal == SIGHUP) {
    sigwait(&waited_for_, &signal);
    if (signal == SIGHUP) {
      reload();
    }
  }
}

void Signals::end_process_after(std::chrono::seconds time) {
  sigset_t stopping = waited_for_;
  sigdelset(&stopping, SIGHUP);
  std::thread([stopping, time] {
    const timespec wait{time.count(), 0};
    const int again = sigtimedwait(&stopping, nullptr, &wait);
    _exit(again > 0 ? 128 + again : 0);
  }).detach();
}

}  // namespace driftlab::server
