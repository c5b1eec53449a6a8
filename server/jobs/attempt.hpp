#pragma once
/// One attempt at one job: from the claim to the row that says how it ended.
///
/// `run` belongs to a worker thread; other threads may call the other functions meanwhile. The store resolves every
/// race between them: each write carries the attempt's number, and a late one changes nothing.
///
/// Whatever happens in these functions counts against this attempt: a fault signal that any of them raises, on
/// whichever thread (fault_recorder.hpp), and an exception in `run`, which stores it as the attempt's failure and
/// throws none.
#include "server/jobs/job_kind.hpp"
#include "server/jobs/job_parts.hpp"
#include "server/jobs/work.hpp"
#include "server/jobs/worker_pool.hpp"

#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>

namespace driftlab::server {

class Attempt final : public Work {
 public:
  /// `kind` may be null: the attempt then fails for good. `divided` is called when other workers can help.
  Attempt(Job job, const JobKind* kind, JobContext& context, Executor& executor, MemoryGate& memory,
          const WorkerOptions& options, const std::function<void(const std::string&)>& changed,
          std::function<void()> divided = {});

  /// Waits for a seat of the executor, runs the job there and writes how it ended.
  void run() override;
  /// Ends the work where it has taken the time that a job may take, writes progress that was thinned out where its time
  /// has come, and renews the lease.
  void tend(bool renew) override;
  /// The work is to end, and the job goes back to the queue.
  void ask_to_stop() override;
  /// The job goes back to the queue now, and what the work still finds is discarded.
  void hand_back() override;

 private:
  void mind_deadline();
  void catch_up();
  /// Learns of a lost lease or a cancel request and then stops the work.
  void renew_lease();
  /// The parts of this job, where it is to be divided; else it is not shared.
  [[nodiscard]] std::shared_ptr<SharedParts> parts_for(const JobCost& cost);
  [[nodiscard]] std::shared_ptr<SharedParts> running_parts();
  /// What `part` returns, or as an error the exception that escaped from it.
  template <class Part>
  [[nodiscard]] auto charged(const Part& part) -> decltype(part());
  void carry_out();
  [[nodiscard]] Result<JobResults> work();
  struct Progress {
    std::string stage;
    double fraction = 0.0;
  };
  void report(std::string_view stage, double fraction);
  /// `progress_mutex_` is held.
  [[nodiscard]] bool too_early() const;
  void tell(const Progress& progress);
  void learn(const LeaseStatus& status);
  void finish(const JobResults& results);
  void fail(const Error& error);
  /// An exception escaped from `carry_out`. The failure is stored as `plain_problem`, for the exception may be one of
  /// what writes problems; where the end of the attempt was stored before, the exception is told only.
  void break_off(const Error& error);
  [[nodiscard]] bool is_retryable(const Error& error) const;
  void store_failure(const AttemptFailure& failure);
  void announce(const Result<LeaseStatus>& written);
  /// The attempt has ended so, where the store took it; else its lease was lost.
  void ended(const Result<LeaseStatus>& written, std::string_view outcome);

  const Job job_;
  const Lease lease_;
  const JobKind* kind_;
  JobContext& context_;
  Executor& executor_;
  MemoryGate& memory_;
  const WorkerOptions& options_;
  const std::function<void(const std::string&)>& changed_;
  const std::function<void()> divided_;
  std::stop_source stop_;
  std::atomic<bool> lost_{false};
  std::atomic<bool> cancel_requested_{false};
  std::atomic<bool> stopping_{false};
  std::atomic<bool> too_long_{false};
  const std::chrono::steady_clock::time_point begun_ = std::chrono::steady_clock::now();
  bool out_of_memory_ = false;
  std::atomic<bool> settled_{false};  ///< the store was told how the attempt ended
  std::mutex parts_mutex_;
  std::shared_ptr<SharedParts> parts_;  ///< once the work has begun, where the job is divided
  std::mutex progress_mutex_;           ///< also orders the writes of the worker and of the heartbeat
  std::optional<Progress> thinned_;     ///< the last report that was not written
  std::optional<std::chrono::steady_clock::time_point> reported_at_;
};

/// The document kept for a failed attempt when the daemon gives no better one.
[[nodiscard]] std::string plain_problem(const Error& error, bool retryable);

}  // namespace driftlab::server
