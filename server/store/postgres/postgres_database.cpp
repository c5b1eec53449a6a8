#include "server/store/postgres/postgres_database.hpp"

#include <algorithm>
#include <chrono>
#include <exception>
#include <string>
#include <thread>

namespace driftlab::server {
namespace {

constexpr std::chrono::seconds kPatience{20};
constexpr int kLongestPauseMicros = 200'000;
/// A row that another transaction made meanwhile is found at the second look; a third says that it is the caller's.
constexpr int kDuplicateAttempts = 3;

constexpr std::string_view kRead = "BEGIN ISOLATION LEVEL REPEATABLE READ, READ ONLY";
constexpr std::string_view kFenced = "BEGIN ISOLATION LEVEL READ COMMITTED";
constexpr std::string_view kSerial = "BEGIN ISOLATION LEVEL SERIALIZABLE";
/// The lock is taken before the snapshot, which therefore holds the last row of the chain.
constexpr std::string_view kAudited =
    "BEGIN ISOLATION LEVEL SERIALIZABLE; LOCK TABLE audit IN SHARE ROW EXCLUSIVE MODE";

std::string_view begin_of(WriteKind kind) {
  switch (kind) {
    case WriteKind::Fenced:
      return kFenced;
    case WriteKind::Audited:
      return kAudited;
    case WriteKind::Serial:
      break;
  }
  return kSerial;
}

/// No exception leaves a transaction open.
Status guarded(const std::function<Status(Connection&)>& work, Connection& connection) {
  try {
    return work(connection);
  } catch (const std::exception& exception) {
    return fail(ErrorCode::Internal, std::string("A transaction failed: ") + exception.what() + ".");
  }
}

/// How one run of a transaction ended, and whether the same may be tried again.
struct Attempt {
  Status status;
  bool again = false;
};

/// Serialisation failure, deadlock, a row that was made meanwhile.
bool is_passing(std::string_view sqlstate, int attempt) {
  return sqlstate == "40001" || sqlstate == "40P01" || (sqlstate == "23505" && attempt < kDuplicateAttempts);
}

Attempt run_once(PostgresConnection& connection, std::string_view begin, const std::function<Status(Connection&)>& work,
                 int attempt, DatabaseClock& told) {
  const auto asked = std::chrono::steady_clock::now();
  Status status = connection.begin(begin);
  if (status) {
    told.note(asked, connection.begun_at(), std::chrono::steady_clock::now());
  }
  if (status) {
    if (begin != kRead) {
      connection.hold_runs();
    }
    status = connection.settle(guarded(work, connection));
  }
  if (begin == kRead && connection.failure().empty() && !connection.is_broken()) {
    connection.end_read();
    return {std::move(status), false};
  }
  const bool nothing_stored = !status || !connection.failure().empty();
  if (!nothing_stored) {
    status = connection.commit();
    if (!status && connection.is_broken() && begin != kRead) {
      return {fail(ErrorCode::Io,
                   "The connection to the database " + connection.name() +
                       " was lost while a write ended; it may have been stored.",
                   {{"database", connection.name()}}),
              false};
    }
  }
  if (status && nothing_stored) {
    status = fail(ErrorCode::Internal, "A transaction went on after a statement had failed.");
  }
  connection.roll_back();
  const bool again = !status && (connection.is_broken() || is_passing(connection.failure(), attempt));
  return {std::move(status), again};
}

}  // namespace

UtcMicros PostgresDatabase::now(const Connection& connection) const {
  return clock_ != nullptr ? clock_->now() : static_cast<const PostgresConnection&>(connection).begun_at();
}

Status PostgresDatabase::run_write(WriteKind kind, const std::function<Status(Connection&)>& work) {
  return repeat(begin_of(kind), work);
}

Status PostgresDatabase::run_read(const std::function<Status(Connection&)>& work) { return repeat(kRead, work); }

Status PostgresDatabase::repeat(std::string_view begin, const std::function<Status(Connection&)>& work) {
  const auto deadline = std::chrono::steady_clock::now() + kPatience;
  bool lost_before = false;
  for (int attempt = 1;; ++attempt) {
    Attempt run;
    bool lost = false;
    {
      auto loan = pool_.take();
      if (!loan) {
        return fail(loan.error());
      }
      run = run_once(**loan, begin, work, attempt, told_);
      lost = (*loan)->is_broken();
    }
    if (!run.again || (lost && lost_before) || std::chrono::steady_clock::now() >= deadline) {
      return std::move(run.status);
    }
    lost_before = lost_before || lost;
    if (!lost) {
      pause(attempt);
    }
  }
}

/// Full jitter over 1 ms, 2 ms, 4 ms, ...
void PostgresDatabase::pause(int attempt) {
  const int bound = std::min(kLongestPauseMicros, 1000 << std::min(attempt - 1, 10));
  std::chrono::microseconds drawn{};
  {
    const std::lock_guard<std::mutex> guard(jitter_mutex_);
    drawn = std::chrono::microseconds(std::uniform_int_distribution<int>(0, bound)(jitter_));
  }
  std::this_thread::sleep_for(drawn);
}

}  // namespace driftlab::server
