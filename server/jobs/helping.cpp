#include "server/jobs/helping.hpp"

#include "server/jobs/fault_recorder.hpp"

#include <utility>

namespace driftlab::server {

Helping::Helping(Job job, const JobKind& kind, JobContext& context, Executor& executor, MemoryGate& memory,
                 const WorkerOptions& options)
    : job_(std::move(job)),
      lease_{job_.id, job_.attempt},
      kind_(kind),
      context_(context),
      executor_(executor),
      memory_(memory),
      parts_(context.store.parts(), job_.id, options.lease_micros, options.helping_micros) {}

void Helping::run() {
  const FaultScope scope(lease_);
  const auto request = parse_json(job_.request_json);
  if (!request || job_.is_damaged) {
    return;  // the job's own worker sees that too, and says so
  }
  const std::stop_source at_once;
  (void)at_once.request_stop();
  const MemoryGate::Share memory(memory_, kind_.cost(*request, context_).memory_bytes, at_once.get_token(), {});
  if (!memory.held()) {
    return;
  }
  const Executor::Seat seat(executor_);
  const RunControl control = charged_to(lease_, executor_, stop_.get_token());
  // A part that ends in an exception is left until its lease runs out: the job's own worker takes it then.
  (void)kind_.run_in_parts(*request, context_, control, parts_);
}

void Helping::tend(bool renew) {
  const FaultScope scope(lease_);
  if (renew && !parts_.renew()) {
    stop_.request_stop();
  }
}

void Helping::hand_back() {
  stop_.request_stop();
  parts_.put_back();
}

}  // namespace driftlab::server
