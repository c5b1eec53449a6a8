#include "server/store/postgres/daemon_lock.hpp"

#include <chrono>
#include <thread>

namespace driftlab::server {
namespace {

/// One lock for each schema; the first number is "drft".
constexpr std::string_view kTake = "SELECT pg_try_advisory_lock(1685218932, hashtext(current_schema()))::INT";
constexpr std::string_view kStillThere = "SELECT 1";
constexpr std::chrono::seconds kPatience{3};

}  // namespace

Status DaemonLock::hold() {
  const std::lock_guard<std::mutex> guard(mutex_);
  if (connection_ && connection_->query_integer(kStillThere)) {
    return {};
  }
  return take();
}

Status DaemonLock::hold_at_start() {
  const auto deadline = std::chrono::steady_clock::now() + kPatience;
  while (true) {
    Status held = hold();
    if (held || held.error().code != ErrorCode::Conflict || std::chrono::steady_clock::now() >= deadline) {
      return held;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
}

Status DaemonLock::take() {
  connection_.reset();
  auto connection = open_();
  if (!connection) {
    return fail(connection.error());
  }
  const auto taken = (*connection)->query_integer(kTake);
  if (!taken) {
    return fail(taken.error());
  }
  if (taken->value_or(0) == 0) {
    return fail(ErrorCode::Conflict,
                "Another daemon works with the database " + (*connection)->name() +
                    "; several of them on one database need recordings in a place that all of them reach, which this "
                    "driftlab cannot yet.",
                {{"database", (*connection)->name()}});
  }
  connection_ = std::move(*connection);
  return {};
}

}  // namespace driftlab::server
