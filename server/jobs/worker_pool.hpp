#pragma once
/// The workers: threads that claim jobs from the store, run them, keep their leases alive and write their results.
///
/// Lease 60 s, renewed every 15 s by a heartbeat thread; a lost lease or a cancel request stops the job through its
/// stop token. Failed attempts are retried only for retryable codes (Io, DiskFull, Internal from std::bad_alloc). An
/// idle worker sleeps until `wake` or one second. On `stop` running jobs are asked to stop and get 20 s to end, then
/// are released. A job may hand independent tasks to the threads that no other job computes on; a fault or an exception
/// there counts against that job's attempt, as one in its worker does. A worker without a job helps with the parts of a
/// long one, also where that runs in another process. The rules of states and retries:
/// server/jobs/README.md.
#include "server/jobs/job_kind.hpp"
#include "server/jobs/maintenance.hpp"

#include <functional>
#include <memory>
#include <string>

namespace driftlab::server {

struct WorkerOptions {
  int threads = 2;  ///< jobs that run at a time
  /// Threads that compute for all jobs together (core/signal/executor.hpp), the workers among them; 0: as many as
  /// workers. A job that finds all of them at work waits for one.
  int computing = 0;
  std::int64_t lease_micros = 60'000'000;
  std::int64_t renew_micros = 15'000'000;
  /// The longest time that an idle worker sleeps before it looks for a job again.
  std::int64_t idle_micros = 1'000'000;
  /// How long `stop` waits for running jobs before it hands them back.
  std::int64_t grace_micros = 20'000'000;
  /// Progress is written at most once in this time (a commit each: a job of many short stages would wait for little
  /// else); what comes sooner is written when the time is over, by the heartbeat where the job says nothing more.
  std::int64_t progress_micros = 100'000;
  /// A job that will take longer than this is divided among workers (server/jobs/job_parts.hpp); one without parts, or
  /// shorter, is not worth the writes.
  double worth_sharing_seconds = 2.0;
  /// How long an idle worker helps with a job of others before it looks for one of its own again.
  std::int64_t helping_micros = 2'000'000;
  /// Runs the maintenance (server/jobs/maintenance.hpp) beside the workers.
  bool maintain = true;
  MaintenanceOptions maintenance = {};
  /// The kinds of jobs that are taken; empty: all. Those of the registry are filled in with it.
  std::vector<KnownKind> known = {};
  /// Called when an attempt has ended, with the job's kind, how it ended (server/observe/metrics.hpp) and the seconds
  /// it took. May be empty.
  std::function<void(std::string_view kind, std::string_view outcome, double seconds)> attempt_ended;
  /// Called when a worker has helped, with the kind of the job and how many of its parts it has finished. May be empty.
  std::function<void(std::string_view kind, int parts)> parts_helped;
  /// Writes the problem document of a failed attempt; empty: a document with `code`, `detail` and `where`.
  std::function<std::string(const Error&)> problem_document;
};

/// Finds the kind of a name, or nullptr.
using JobKindLookup = std::function<const JobKind*(std::string_view name)>;

class WorkerPool {
 public:
  /// `changed` is called (from any thread) with a job id after each event row of that job, so that SSE streams wake up.
  /// Kinds come from the registry (job_kinds.cpp).
  WorkerPool(JobContext context, WorkerOptions options, std::function<void(const std::string& job_id)> changed);
  /// The same with other kinds, for tests.
  WorkerPool(JobContext context, WorkerOptions options, std::function<void(const std::string& job_id)> changed,
             JobKindLookup kinds);
  WorkerPool(const WorkerPool&) = delete;
  WorkerPool& operator=(const WorkerPool&) = delete;
  ~WorkerPool();

  void start();
  /// A job was queued or cancelled: look now. Thread safe, never blocks.
  void wake();
  /// Stops claiming and asks running jobs to stop; returns at once. Thread safe.
  void ask_to_stop();
  /// Stops claiming, asks running jobs to stop, joins. Idempotent.
  void stop();
  /// Jobs running now.
  [[nodiscard]] int busy() const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace driftlab::server
