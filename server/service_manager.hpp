#pragma once
/// What the daemon tells the service manager that started it (sd_notify(3)): ready, reloading, stopping, and, where a
/// watchdog is set, that it is alive. Without `NOTIFY_SOCKET` nothing is said.
#include <chrono>
#include <functional>
#include <string>
#include <string_view>
#include <thread>

namespace driftlab::server {

class ServiceManager {
 public:
  /// From NOTIFY_SOCKET, WATCHDOG_USEC and WATCHDOG_PID. Call before threads start.
  ServiceManager();
  /// `socket`: a path, or an abstract name behind `@`; empty: there is no service manager. `watchdog` 0: none is set.
  ServiceManager(std::string socket, std::chrono::microseconds watchdog)
      : socket_(std::move(socket)), watchdog_(watchdog) {}

  /// One datagram of assignments, `READY=1`. A datagram that cannot be sent is dropped; the call never waits.
  void tell(std::string_view words) const;

  /// Tells twice in each time of the watchdog that the process is alive, as long as `is_alive` says so. `is_alive` gets
  /// the time it may take. Where it does not, the service manager ends the process.
  void watch(std::function<bool(std::chrono::milliseconds)> is_alive);
  void stop_watching();

 private:
  std::string socket_;
  std::chrono::microseconds watchdog_{0};
  std::jthread watcher_;
};

}  // namespace driftlab::server
