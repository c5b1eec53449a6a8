#include "server/store/sqlite/writer.hpp"

#include <chrono>
#include <exception>
#include <string>

namespace driftlab::server {
namespace {

constexpr std::size_t kQueueSize = 256;
constexpr std::size_t kBatchSize = 64;
constexpr std::chrono::milliseconds kBatchTime{5};

/// No exception may end the writer's thread.
Status guarded(const std::function<Status(SqliteConnection&)>& work, SqliteConnection& connection) {
  try {
    return work(connection);
  } catch (const std::exception& exception) {
    return fail(ErrorCode::Internal, std::string("A write failed: ") + exception.what() + ".");
  }
}

}  // namespace

Writer::Writer(std::unique_ptr<SqliteConnection> connection, std::unique_ptr<CommitLog> commits)
    : connection_(std::move(connection)), commits_(std::move(commits)) {
  thread_ = std::thread([this] { run(); });
}

Writer::~Writer() {
  {
    const std::lock_guard<std::mutex> guard(mutex_);
    closing_ = true;
  }
  work_queued_.notify_all();
  thread_.join();
  if (commits_) {
    (void)commits_->require_whole_log(*connection_);
  }
}

Status Writer::begin() {
  const Status whole = commits_ ? commits_->require_whole_log(*connection_) : Status{};
  return whole ? connection_->prepare("BEGIN IMMEDIATE").run() : whole;
}

Status Writer::commit(std::int64_t changes_before) {
  Status done;
  if (commits_ && connection_->total_changes() != changes_before) {
    done = commits_->count(*connection_);
  }
  if (done) {
    done = connection_->prepare("COMMIT").run();
  }
  if (done && commits_) {
    commits_->note_committed();
  }
  return done;
}

Status Writer::submit(std::function<Status(SqliteConnection&)> work) {
  Task task{std::move(work), {}, false};
  std::unique_lock<std::mutex> guard(mutex_);
  room_.wait(guard, [this] { return queue_.size() < kQueueSize; });
  queue_.push_back(&task);
  work_queued_.notify_one();
  work_done_.wait(guard, [&task] { return task.done; });
  return std::move(task.outcome);
}

Writer::Task* Writer::next(bool wait) {
  std::unique_lock<std::mutex> guard(mutex_);
  if (wait) {
    work_queued_.wait(guard, [this] { return closing_ || !queue_.empty(); });
  }
  if (queue_.empty()) {
    return nullptr;
  }
  Task* task = queue_.front();
  queue_.pop_front();
  room_.notify_one();
  return task;
}

void Writer::announce(const std::vector<Task*>& tasks) {
  {
    const std::lock_guard<std::mutex> guard(mutex_);
    for (Task* task : tasks) {
      task->done = true;
    }
  }
  work_done_.notify_all();
}

void Writer::run() {
  while (Task* first = next(true)) {
    const std::int64_t before = connection_->total_changes();
    const std::vector<Task*> batch = run_batch(first);
    if (connection_->total_changes() != before) {
      changes_.fetch_add(1, std::memory_order_acq_rel);
    }
    announce(batch);
  }
}

Status Writer::run_in_savepoint(Task& task) {
  if (Status begun = connection_->prepare("SAVEPOINT task").run(); !begun) {
    return begun;
  }
  task.outcome = guarded(task.work, *connection_);
  if (!connection_->in_transaction()) {
    return task.outcome ? fail(ErrorCode::Internal, "A write ended its transaction.") : fail(task.outcome.error());
  }
  if (!task.outcome) {
    if (Status undone = connection_->prepare("ROLLBACK TO task").run(); !undone) {
      return undone;
    }
  }
  return connection_->prepare("RELEASE task").run();
}

std::vector<Writer::Task*> Writer::run_batch(Task* first) {
  std::vector<Task*> batch = {first};
  const auto end = std::chrono::steady_clock::now() + kBatchTime;
  const std::int64_t before = connection_->total_changes();
  Status status = begin();
  if (status) {
    status = run_in_savepoint(*first);
  }
  while (status && batch.size() < kBatchSize && std::chrono::steady_clock::now() < end) {
    Task* task = next(false);
    if (task == nullptr) {
      break;
    }
    batch.push_back(task);
    status = run_in_savepoint(*task);
  }
  if (status) {
    status = commit(before);
  }
  if (status) {
    return batch;
  }
  if (connection_->in_transaction()) {
    (void)connection_->prepare("ROLLBACK").run();
  }
  if (batch.size() == 1) {
    first->outcome = std::move(status);
    return batch;
  }
  for (Task* task : batch) {
    run_alone(*task);
  }
  return batch;
}

void Writer::run_alone(Task& task) {
  const std::int64_t before = connection_->total_changes();
  Status status = begin();
  if (status) {
    task.outcome = guarded(task.work, *connection_);
    if (!task.outcome) {
      status = fail(task.outcome.error());
    } else {
      status = commit(before);  // refused where the work ended the transaction
    }
  }
  if (!status) {
    if (connection_->in_transaction()) {
      (void)connection_->prepare("ROLLBACK").run();
    }
    task.outcome = std::move(status);
  }
}

}  // namespace driftlab::server
