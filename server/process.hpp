#pragma once
/// What the daemon asks of the process it runs in: signals and standard descriptors.
#include <signal.h>

#include <chrono>
#include <functional>

namespace driftlab::server {

/// Opens /dev/null in the place of a standard input, output or error that whoever started the process had closed.
/// Without this the first file that is opened takes the number 2, and log lines go into it. Call before anything is
/// opened.
void occupy_standard_descriptors();

/// What the process has taken so far.
struct ProcessUse {
  double resident_bytes = 0.0;
  double cpu_seconds = 0.0;
};
[[nodiscard]] ProcessUse use_of_this_process();

/// SIGTERM, SIGINT and SIGHUP arrive at the thread that waits for them and at no other; SIGPIPE and SIGXFSZ are errors
/// of the write that met them, not the end of the process.
class Signals {
 public:
  /// Call before threads start: they inherit the mask.
  Signals();
  /// Returns at SIGTERM or SIGINT. Calls `reload` at each SIGHUP.
  void wait_for_stop(const std::function<void()>& reload);
  /// A second signal ends the process at once, and so does the end of this time, whatever still runs: the store is safe
  /// at any moment.
  void end_process_after(std::chrono::seconds time);

 private:
  sigset_t waited_for_{};
};

}  // namespace driftlab::server
