#include "server/store/postgres/daemon_lock.hpp"

#include "server/store/postgres/advisory_locks.hpp"

#include <chrono>
#include <thread>

namespace driftlab::server {
namespace {

using namespace advisory_locks;

constexpr std::string_view kStillThere = "SELECT 1";
constexpr std::string_view kHasSchema = "SELECT (current_schema() IS NOT NULL)::INT";
constexpr std::chrono::seconds kPatience{3};
constexpr std::chrono::seconds kPatienceTogether{20};

Result<bool> is_granted(PostgresConnection& connection, std::string_view sql) {
  return connection.query_integer(sql).map([](std::optional<std::int64_t> row) { return row.value_or(0) != 0; });
}

}  // namespace

Status DaemonLock::hold() {
  const std::lock_guard<std::mutex> guard(mutex_);
  if (connection_ && connection_->query_integer(kStillThere)) {
    return {};
  }
  return take();
}

Status DaemonLock::hold_at_start() {
  const auto patience = kind_ == Kind::Alone ? kPatience : kPatienceTogether;
  const auto deadline = std::chrono::steady_clock::now() + patience;
  while (true) {
    Status held = hold();
    if (held || held.error().code != ErrorCode::Conflict || std::chrono::steady_clock::now() >= deadline) {
      return held;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
}

Status DaemonLock::admit_others() {
  const std::lock_guard<std::mutex> guard(mutex_);
  const bool alone_now = kind_ == Kind::Together && starting_ && came_first_;
  starting_ = false;
  if (!alone_now || !connection_) {
    return {};
  }
  for (const std::string_view step : {kTakeTogether, kEndAlone}) {
    if (const auto done = is_granted(*connection_, step); !done) {
      return fail(done.error());
    }
  }
  return {};
}

Result<bool> DaemonLock::try_lock(PostgresConnection& connection) {
  const bool alone = kind_ == Kind::Alone || starting_;
  auto first = alone ? is_granted(connection, kTakeAlone) : Result<bool>(false);
  if (!first || *first) {
    came_first_ = came_first_ || (first && *first && starting_);
    return first;
  }
  return kind_ == Kind::Together ? is_granted(connection, kTakeTogether) : Result<bool>(false);
}

Status DaemonLock::take() {
  connection_.reset();
  came_first_ = came_first_ && !starting_;
  auto connection = open_();
  if (!connection) {
    return fail(connection.error());
  }
  // Without a schema the locks have no name, and none is granted.
  const auto has_schema = is_granted(**connection, kHasSchema);
  if (!has_schema) {
    return fail(has_schema.error());
  }
  if (!*has_schema) {
    return fail(ErrorCode::Io,
                "In the database " + (*connection)->name() +
                    " there is no schema that its user may use; GRANT USAGE, CREATE ON SCHEMA to the user, or name "
                    "another by options=-csearch_path=NAME.",
                {{"database", (*connection)->name()}});
  }
  const auto taken = try_lock(**connection);
  if (!taken) {
    return fail(taken.error());
  }
  if (!*taken) {
    const char* const way_out =
        kind_ == Kind::Alone
            ? "; several of them on one database need recordings in a place that all of them reach (--blobs)."
            : ", and keeps the recordings in its own --data; start that with --blobs too.";
    return fail(ErrorCode::Conflict, "Another daemon works with the database " + (*connection)->name() + way_out,
                {{"database", (*connection)->name()}});
  }
  connection_ = std::move(*connection);
  return {};
}

}  // namespace driftlab::server
