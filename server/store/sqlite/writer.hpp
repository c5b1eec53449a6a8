#pragma once
/// The one thread that writes: callers hand it work and wait until it is on disk.
///
/// Work that is queued while a transaction is being flushed is committed together in the next one (group commit): at
/// most kBatchSize pieces or kBatchTime, whichever comes first; work is never delayed to fill a batch. Each piece runs
/// inside a savepoint, so that one that fails takes nothing of its neighbours with it. Where the whole transaction
/// fails (a full disk), each piece is tried once more alone, so that a large one does not fail the small ones. A piece
/// of work may therefore run twice, but what it did the first time is undone.
#include "core/signal/result.hpp"
#include "server/store/sqlite/commit_log.hpp"
#include "server/store/sqlite/connection.hpp"

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

namespace driftlab::server {

class Writer {
 public:
  /// `commits` counts what is committed; nullptr: nobody does.
  explicit Writer(std::unique_ptr<SqliteConnection> connection, std::unique_ptr<CommitLog> commits = nullptr);
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;
  /// Finishes what is queued, then closes the connection.
  ~Writer();

  /// Runs `work(connection)`, which returns a `Result`, in a transaction and returns its outcome once that is durable.
  /// Blocks while the queue is full. Thread safe; not to be called from within `work`.
  template <class Work>
  [[nodiscard]] auto write(Work work) {
    using Outcome = std::invoke_result_t<Work, SqliteConnection&>;
    Outcome outcome = fail(ErrorCode::Internal, "The write did not run.");
    Status committed = submit([&](SqliteConnection& connection) -> Status {
      outcome = work(connection);
      if (!outcome) {
        return fail(outcome.error());
      }
      return {};
    });
    if (!committed) {
      return Outcome(fail(std::move(committed.error())));
    }
    return outcome;
  }

  /// Grows with every transaction that changed a row, before the outcome of its work is told.
  [[nodiscard]] std::uint64_t changes() const { return changes_.load(std::memory_order_acquire); }

 private:
  struct Task {
    std::function<Status(SqliteConnection&)> work;
    Status outcome;
    bool done = false;
  };

  [[nodiscard]] Status submit(std::function<Status(SqliteConnection&)> work);
  void run();
  [[nodiscard]] Task* next(bool wait);
  [[nodiscard]] std::vector<Task*> run_batch(Task* first);
  [[nodiscard]] Status run_in_savepoint(Task& task);
  void run_alone(Task& task);
  [[nodiscard]] Status begin();
  [[nodiscard]] Status commit(std::int64_t changes_before);
  void announce(const std::vector<Task*>& tasks);

  std::unique_ptr<SqliteConnection> connection_;
  std::unique_ptr<CommitLog> commits_;
  std::mutex mutex_;
  std::condition_variable work_queued_;
  std::condition_variable work_done_;
  std::condition_variable room_;
  std::deque<Task*> queue_;
  bool closing_ = false;
  std::atomic<std::uint64_t> changes_{1};
  std::thread thread_;
};

}  // namespace driftlab::server
