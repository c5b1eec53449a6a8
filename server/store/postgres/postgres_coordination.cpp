#include "server/store/postgres/postgres_coordination.hpp"

#include "server/store/guarded_round.hpp"
#include "server/store/postgres/advisory_locks.hpp"
#include "server/store/silent_store.hpp"

#include <condition_variable>

namespace driftlab::server {
namespace {

using namespace std::chrono_literals;
using namespace advisory_locks;

constexpr auto kPause = 1s;        // between attempts to reach a database that does not answer
constexpr auto kAccessEvery = 2s;  // Hints::access
constexpr auto kLook = 200ms;      // longest wait for a notification before the stop is looked at
constexpr std::size_t kLongestWords = 7900;

constexpr std::string_view kStillThere = "SELECT 1";
constexpr std::string_view kTell = "SELECT 1 FROM (SELECT pg_notify('driftlab_' || md5(current_schema()), ?1)) AS told";
constexpr std::string_view kChannel = "SELECT 'driftlab_' || md5(current_schema())";

Result<bool> is_granted(PostgresConnection& connection, std::string_view sql, std::string_view key) {
  Statement statement = connection.prepare(sql);
  statement.bind(key);
  const auto row = statement.step();
  if (!row) {
    return fail(row.error());
  }
  return *row && statement.integer(0) != 0;
}

/// How many are held.
Result<std::int64_t> hold_workers(PostgresConnection& connection, int count) {
  Statement statement = connection.prepare(kTakeWorkers);
  statement.bind(count);
  const auto row = statement.step();
  return row ? Result<std::int64_t>(*row ? statement.integer(0) : 0) : fail(row.error());
}

Result<std::unique_ptr<PostgresConnection>> open_listener(const ConnectionPool::Opener& open) {
  auto connection = open();
  if (!connection) {
    return connection;
  }
  const auto channel = (*connection)->query_text(kChannel);
  if (!channel) {
    return fail(channel.error());
  }
  if (auto listening = (*connection)->execute("LISTEN " + channel->value_or("driftlab")); !listening) {
    return fail(listening.error());
  }
  return connection;
}

/// Sleeps unless it is to stop.
void rest(const std::stop_token& stop, std::chrono::milliseconds time) {
  std::mutex mutex;
  std::unique_lock<std::mutex> lock(mutex);
  std::condition_variable_any().wait_for(lock, stop, time, [] { return false; });
}

}  // namespace

Status PostgresCoordination::connect() {
  if (connection_ && connection_->query_integer(kStillThere)) {
    return {};
  }
  connection_.reset();
  duties_.fill(false);
  const auto now = std::chrono::steady_clock::now();
  if (now < not_before_) {
    return fail(silent_store("The database does not answer; it is asked again within a second."));
  }
  auto opened = open_();
  if (!opened) {
    not_before_ = std::chrono::steady_clock::now() + kPause;
    return fail(opened.error());
  }
  connection_ = std::move(*opened);
  // Somebody else may hold one by now; then two requests with it run, and the first reply that is kept holds.
  for (const std::string& key : keys_) {
    (void)is_granted(*connection_, kTakeKey, key);
  }
  (void)hold_workers(*connection_, workers_);
  return {};
}

bool PostgresCoordination::has_duty(Duty duty) {
  const std::lock_guard<std::mutex> guard(mutex_);
  const auto index = static_cast<std::size_t>(duty);
  if (!connect()) {
    return false;
  }
  if (!duties_[index]) {
    duties_[index] = connection_->query_integer(kTakeDuty[index]).value_or(std::nullopt).value_or(0) != 0;
  }
  return duties_[index];
}

Result<bool> PostgresCoordination::take_key(std::string_view key) {
  const std::lock_guard<std::mutex> guard(mutex_);
  if (Status there = connect(); !there) {
    return fail(there.error());
  }
  auto taken = is_granted(*connection_, kTakeKey, key);
  if (taken && *taken) {
    keys_.emplace(key);
  }
  return taken;
}

void PostgresCoordination::give_back_key(std::string_view key) {
  const std::lock_guard<std::mutex> guard(mutex_);
  if (const auto held = keys_.find(key); held != keys_.end()) {
    keys_.erase(held);
  }
  if (connection_) {
    (void)is_granted(*connection_, kGiveBackKey, key);
  }
}

void PostgresCoordination::offer_workers(int count) {
  const std::lock_guard<std::mutex> guard(mutex_);
  workers_ = count;
  // What a connection that was made just now holds already counts once.
  if (connect()) {
    (void)hold_workers(*connection_, workers_);
  }
}

Result<int> PostgresCoordination::workers() {
  const std::lock_guard<std::mutex> guard(mutex_);
  if (Status there = connect(); !there) {
    return fail(there.error());
  }
  const auto counted = connection_->query_integer(kCountWorkers);
  return counted ? Result<int>(static_cast<int>(counted->value_or(0))) : fail(counted.error());
}

void PostgresCoordination::tell(std::string_view words) {
  const std::string payload =
      words.size() > kLongestWords ? "lost " + origin_ : "words " + origin_ + " " + std::string(words);
  const std::lock_guard<std::mutex> guard(mutex_);
  if (connect()) {
    (void)is_granted(*connection_, kTell, payload);
  }
}

void PostgresCoordination::listen(Hints hints) {
  hearing_ = std::jthread([this, told = std::move(hints)](const std::stop_token& stop) { hear(stop, told); });
}

void PostgresCoordination::stop() {
  hearing_.request_stop();
  if (hearing_.joinable()) {
    hearing_.join();
  }
}

void PostgresCoordination::hear(const std::stop_token& stop, const Hints& hints) {
  std::unique_ptr<PostgresConnection> connection;
  auto access_at = std::chrono::steady_clock::now();
  bool heard_before = false;
  const auto listen_once = [&] {
    if (!connection) {
      auto opened = open_listener(open_);
      if (!opened) {
        rest(stop, kPause);
        return;
      }
      connection = std::move(*opened);
      if (heard_before) {
        hints.lost();
      }
      heard_before = true;
    }
    const auto payloads = connection->notifications(kLook);
    if (!payloads) {
      connection.reset();
      return;
    }
    for (const std::string& payload : *payloads) {
      pass_on(hints, payload);
    }
    if (const auto now = std::chrono::steady_clock::now(); now - access_at >= kAccessEvery) {
      access_at = now;
      hints.access();
    }
  };
  while (!stop.stop_requested()) {
    if (!guarded_round("hints of other daemons", listen_once)) {
      connection.reset();  // what came with it may not have been passed on: the next connection says `lost`
      rest(stop, kPause);
    }
  }
}

/// `KIND ORIGIN REST`, KIND being job, access, words or lost.
void PostgresCoordination::pass_on(const Hints& hints, const std::string& payload) const {
  const std::size_t origin = std::min(payload.find(' '), payload.size());
  const std::size_t rest = std::min(payload.find(' ', origin + 1), payload.size());
  const std::string_view kind = std::string_view(payload).substr(0, origin);
  if (origin == payload.size() || std::string_view(payload).substr(origin + 1, rest - origin - 1) == origin_) {
    return;
  }
  const std::string what = rest < payload.size() ? payload.substr(rest + 1) : "";
  if (kind == "job") {
    const std::size_t id = std::min(what.find(' '), what.size());
    hints.job(what.substr(0, id), std::string_view(what).substr(std::min(id + 1, what.size())));
  } else if (kind == "access") {
    hints.access();
  } else if (kind == "words") {
    hints.words(what);
  } else if (kind == "lost") {
    hints.lost();
  }
}

}  // namespace driftlab::server
