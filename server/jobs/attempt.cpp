#include "server/jobs/attempt.hpp"

#include "schema/json/json.hpp"
#include "server/jobs/fault_recorder.hpp"
#include "server/store/crash_point.hpp"

#include <exception>
#include <new>
#include <utility>

namespace driftlab::server {

Attempt::Attempt(Job job, const JobKind* kind, JobContext& context, Executor& executor, const WorkerOptions& options,
                 const std::function<void(const std::string&)>& changed)
    : job_(std::move(job)),
      lease_{job_.id, job_.attempt},
      kind_(kind),
      context_(context),
      executor_(executor),
      options_(options),
      changed_(changed) {}

void Attempt::run() {
  crash_point("job.claimed");
  if (changed_) {
    changed_(job_.id);
  }
  const Result<JobResults> results = work();
  if (results) {
    finish(*results);
  } else {
    fail(results.error());
  }
}

Result<JobResults> Attempt::work() {
  if (kind_ == nullptr) {
    return driftlab::fail(ErrorCode::Internal, "This daemon knows no job of kind \"" + job_.kind + "\".",
                          {{"kind", job_.kind}});
  }
  RunControl control;
  control.stop = stop_.get_token();
  control.progress = [this](std::string_view stage, double fraction) { report(stage, fraction); };
  control.threads.executor = &executor_;
  control.threads.around = [this](const std::function<void()>& helping) {
    const FaultScope scope(lease_);
    helping();
  };
  const FaultScope scope(lease_);
  try {
    const auto request = parse_json(job_.request_json);
    const Executor::Seat seat(executor_);
    return request ? kind_->run(*request, context_, control) : driftlab::fail(request.error());
  } catch (const std::bad_alloc&) {
    out_of_memory_ = true;
    return driftlab::fail(ErrorCode::Internal, "There was not enough memory for the job.");
  } catch (const std::exception& exception) {
    return driftlab::fail(ErrorCode::Internal, std::string("The job broke off: ") + exception.what() + ".");
  } catch (...) {
    return driftlab::fail(ErrorCode::Internal, "The job broke off for an unknown reason.");
  }
}

bool Attempt::too_early() const {
  const auto now = std::chrono::steady_clock::now();
  return reported_at_ && now - *reported_at_ < std::chrono::microseconds(options_.progress_micros);
}

void Attempt::report(std::string_view stage, double fraction) {
  const std::lock_guard<std::mutex> guard(progress_mutex_);
  Progress progress{std::string(stage), fraction};
  if (too_early()) {
    thinned_ = std::move(progress);
    return;
  }
  const bool first = !reported_at_;
  tell(progress);
  if (first) {
    crash_point("job.working");
  }
}

void Attempt::catch_up() {
  const std::lock_guard<std::mutex> guard(progress_mutex_);
  if (thinned_ && !too_early()) {
    tell(Progress(*thinned_));
  }
}

void Attempt::tell(const Progress& progress) {
  thinned_.reset();
  if (lost_) {
    return;
  }
  reported_at_ = std::chrono::steady_clock::now();
  const Result<LeaseStatus> written = context_.store.report_progress(lease_, progress.stage, progress.fraction);
  announce(written);
  if (written) {
    learn(*written);
  }
}

void Attempt::learn(const LeaseStatus& status) {
  if (!status.held) {
    lost_ = true;
  } else if (status.cancel_requested) {
    cancel_requested_ = true;
  } else {
    return;
  }
  stop_.request_stop();
}

void Attempt::renew() {
  // A renewal that the store could not write is tried again at the next beat; the lease spans four of them.
  const Result<LeaseStatus> renewed = context_.store.renew(lease_, options_.lease_micros);
  if (renewed) {
    learn(*renewed);
  }
}

void Attempt::ask_to_stop() {
  stopping_ = true;
  stop_.request_stop();
}

void Attempt::hand_back() {
  lost_ = true;
  stop_.request_stop();
  announce(context_.store.release(lease_));
}

void Attempt::finish(const JobResults& results) {
  crash_point("job.before_finish");
  const Result<LeaseStatus> written = context_.store.succeed(lease_, results);
  if (!written) {
    fail(written.error());
    return;
  }
  if (written->held) {
    crash_point("job.finished");
  }
  announce(written);
}

void Attempt::fail(const Error& error) {
  if (lost_) {
    return;
  }
  if (error.code == ErrorCode::Cancelled) {
    // The work may have learnt before the heartbeat did that nobody wants it any more; the store knows.
    const Result<LeaseStatus> asked = context_.store.acknowledge_cancel(lease_);
    if (asked && (asked->cancel_requested || !asked->held)) {
      announce(asked);
      return;
    }
    if (stopping_) {
      announce(context_.store.release(lease_));
      return;
    }
  }
  AttemptFailure failure;
  failure.retryable = out_of_memory_ || error.code == ErrorCode::Io || error.code == ErrorCode::DiskFull;
  failure.problem_json =
      options_.problem_document ? options_.problem_document(error) : plain_problem(error, failure.retryable);
  // Where even this cannot be written, the lease runs out and the job is tried again.
  announce(context_.store.fail_attempt(lease_, failure));
}

void Attempt::announce(const Result<LeaseStatus>& written) {
  if (written && written->held && changed_) {
    changed_(job_.id);
  }
}

std::string plain_problem(const Error& error, bool retryable) {
  Json where = Json::object();
  for (const ErrorField& field : error.fields) {
    where[field.name] = field.value;
  }
  return to_text(Json{
      {"code", name_of(error.code)}, {"detail", error.message}, {"retryable", retryable}, {"where", std::move(where)}});
}

}  // namespace driftlab::server
