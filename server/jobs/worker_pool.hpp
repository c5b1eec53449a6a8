#pragma once
/// The workers: threads that claim jobs from the store, run them, keep their leases alive and write their results.
///
/// Lease 60 s, renewed every 15 s by a heartbeat thread; a lost lease or a cancel request stops the job through its
/// stop token. Failed attempts are retried only for retryable codes (Io, DiskFull, Internal from std::bad_alloc). An
/// idle worker sleeps until `wake` or one second. On `stop` running jobs get 20 s to end, then are released.
#include "server/jobs/job_kind.hpp"

#include <functional>
#include <memory>

namespace driftlab::server {

struct WorkerOptions {
  int threads = 2;
  std::int64_t lease_micros = 60'000'000;
  std::int64_t renew_micros = 15'000'000;
};

class WorkerPool {
 public:
  /// `changed` is called (from any thread) with a job id after each event row of that job, so that SSE streams wake up.
  WorkerPool(JobContext context, WorkerOptions options, std::function<void(const std::string& job_id)> changed);
  WorkerPool(const WorkerPool&) = delete;
  WorkerPool& operator=(const WorkerPool&) = delete;
  ~WorkerPool();

  void start();
  /// A job was queued or cancelled: look now. Thread safe, never blocks.
  void wake();
  /// Stops claiming, asks running jobs to stop, joins. Idempotent.
  void stop();
  /// Jobs running now.
  [[nodiscard]] int busy() const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace driftlab::server
