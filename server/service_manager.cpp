#include "server/service_manager.hpp"

#include "server/store/files.hpp"
#include "server/store/guarded_round.hpp"

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <condition_variable>
#include <cstddef>
#include <cstdlib>
#include <mutex>
#include <stop_token>

namespace driftlab::server {
namespace {

std::string variable(const char* name) {
  const char* const value = std::getenv(name);  // NOLINT(concurrency-mt-unsafe): read before any thread exists
  return value == nullptr ? "" : value;
}

std::int64_t number_of(const std::string& text) {
  std::int64_t number = 0;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc{} && stop == text.data() + text.size() ? number : 0;
}

}  // namespace

ServiceManager::ServiceManager() : socket_(variable("NOTIFY_SOCKET")) {
  const std::string process = variable("WATCHDOG_PID");
  if (process.empty() || number_of(process) == ::getpid()) {
    watchdog_ = std::chrono::microseconds(std::max<std::int64_t>(0, number_of(variable("WATCHDOG_USEC"))));
  }
}

void ServiceManager::tell(std::string_view words) const {
  ::sockaddr_un address{};
  if (socket_.empty() || socket_.size() >= sizeof(address.sun_path)) {
    return;
  }
  address.sun_family = AF_UNIX;
  std::copy(socket_.begin(), socket_.end(), std::begin(address.sun_path));
  if (socket_.front() == '@') {
    address.sun_path[0] = '\0';
  }
  const FileHandle out(::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  if (out.get() < 0) {
    return;
  }
  const auto length = static_cast<::socklen_t>(offsetof(::sockaddr_un, sun_path) + socket_.size());
  (void)::sendto(out.get(), words.data(), words.size(), MSG_NOSIGNAL | MSG_DONTWAIT,
                 reinterpret_cast<const ::sockaddr*>(&address), length);
}

void ServiceManager::watch(std::function<bool(std::chrono::milliseconds)> is_alive) {
  if (socket_.empty() || watchdog_.count() == 0) {
    return;
  }
  watcher_ = std::jthread([this, is_alive = std::move(is_alive)](const std::stop_token& stop) {
    const auto turn = std::chrono::duration_cast<std::chrono::milliseconds>(watchdog_ / 2);
    std::mutex mutex;
    std::unique_lock<std::mutex> lock(mutex);
    std::condition_variable_any resting;
    while (!stop.stop_requested()) {
      (void)guarded_round("watchdog", [&] {
        if (is_alive(turn / 2)) {
          tell("WATCHDOG=1");
        }
      });
      (void)resting.wait_for(lock, stop, turn / 2, [] { return false; });
    }
  });
}

void ServiceManager::stop_watching() {
  watcher_.request_stop();
  if (watcher_.joinable()) {
    watcher_.join();
  }
}

}  // namespace driftlab::server
