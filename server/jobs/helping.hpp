#pragma once
/// Help with the parts of a job that another worker runs, of this process or another (job_parts.hpp).
///
/// A helper does as the job's kind does up to where the work is divided, and works on parts there. It writes nothing
/// but what they found. A fault signal counts against the attempt that was under way when it began.
#include "server/jobs/job_parts.hpp"
#include "server/jobs/work.hpp"
#include "server/jobs/worker_pool.hpp"

#include <stop_token>

namespace driftlab::server {

class Helping final : public Work {
 public:
  /// `job` as PartStore::job_to_help gave it; `kind` is its kind.
  Helping(Job job, const JobKind& kind, JobContext& context, Executor& executor, MemoryGate& memory,
          const WorkerOptions& options);

  /// Ends at once where the memory that the job takes is not free: whoever waits for it would keep others from theirs.
  void run() override;
  void tend(bool renew) override;
  void ask_to_stop() override { stop_.request_stop(); }
  void hand_back() override;

  /// How many parts it has finished.
  [[nodiscard]] int finished() const { return parts_.finished(); }

 private:
  const Job job_;
  const Lease lease_;
  const JobKind& kind_;
  JobContext& context_;
  Executor& executor_;
  MemoryGate& memory_;
  std::stop_source stop_;
  HelpedParts parts_;
};

}  // namespace driftlab::server
