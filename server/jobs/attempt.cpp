#include "server/jobs/attempt.hpp"

#include "schema/json/json.hpp"
#include "server/jobs/fault_recorder.hpp"
#include "server/store/crash_point.hpp"
#include "server/store/guarded_round.hpp"

#include <exception>
#include <new>
#include <utility>

namespace driftlab::server {

Attempt::Attempt(Job job, const JobKind* kind, JobContext& context, Executor& executor, MemoryGate& memory,
                 const WorkerOptions& options, const std::function<void(const std::string&)>& changed,
                 std::function<void()> divided)
    : job_(std::move(job)),
      lease_{job_.id, job_.attempt},
      kind_(kind),
      context_(context),
      executor_(executor),
      memory_(memory),
      options_(options),
      changed_(changed),
      divided_(std::move(divided)) {}

template <class Part>
auto Attempt::charged(const Part& part) -> decltype(part()) {
  try {
    return part();
  } catch (const std::bad_alloc&) {
    out_of_memory_ = true;
    return driftlab::fail(ErrorCode::Internal, "There was not enough memory for the job.");
  } catch (const std::exception& exception) {
    return driftlab::fail(ErrorCode::Internal, std::string("The job broke off: ") + exception.what() + ".");
  } catch (...) {
    return driftlab::fail(ErrorCode::Internal, "The job broke off for an unknown reason.");
  }
}

void Attempt::run() {
  const FaultScope scope(lease_);
  const Status carried_out = charged([this]() -> Status {
    carry_out();
    return {};
  });
  if (!carried_out) {
    break_off(carried_out.error());
  }
}

void Attempt::carry_out() {
  crash_point("job.claimed");
  if (changed_) {
    changed_(job_.id);
  }
  const Result<JobResults> results = charged([this] { return work(); });
  if (const auto parts = running_parts()) {
    parts->put_back();  // where an exception left one
  }
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
  if (job_.is_damaged) {
    const Result<Job> sound = context_.store.job(job_.id);  // tells whoever is to know
    if (!sound) {
      return driftlab::fail(sound.error());
    }
  }
  RunControl control = charged_to(lease_, executor_, stop_.get_token());
  control.progress = [this](std::string_view stage, double fraction) { report(stage, fraction); };
  const auto request = parse_json(job_.request_json);
  if (!request) {
    return driftlab::fail(request.error());
  }
  const JobCost cost = kind_->cost(*request, context_);
  const MemoryGate::Share memory(memory_, cost.memory_bytes, control.stop, [this] { report("wait for memory", 0.0); });
  if (!memory.held()) {
    return driftlab::fail(ErrorCode::Cancelled, "The job was stopped while it waited for memory.");
  }
  const Executor::Seat seat(executor_);
  if (const auto shared = parts_for(cost)) {
    return kind_->run_in_parts(*request, context_, control, *shared);
  }
  PartsHere here;
  return kind_->run_in_parts(*request, context_, control, here);
}

std::shared_ptr<SharedParts> Attempt::parts_for(const JobCost& cost) {
  if (cost.seconds + cost.shared_seconds < options_.worth_sharing_seconds) {
    return nullptr;
  }
  const std::lock_guard<std::mutex> guard(parts_mutex_);
  parts_ = std::make_shared<SharedParts>(context_.store.parts(), lease_, options_.lease_micros, divided_);
  return parts_;
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

void Attempt::mind_deadline() {
  const auto most = std::chrono::seconds(context_.budgets.job_seconds);
  if (!too_long_ && std::chrono::steady_clock::now() - begun_ > most) {
    too_long_ = true;
    stop_.request_stop();
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

void Attempt::tend(bool renew) {
  const FaultScope scope(lease_);
  mind_deadline();
  catch_up();
  if (renew) {
    renew_lease();
  }
}

void Attempt::renew_lease() {
  // A renewal that the store could not write is tried again at the next beat; the lease spans four of them.
  const Result<LeaseStatus> renewed = context_.store.renew(lease_, options_.lease_micros);
  if (renewed) {
    learn(*renewed);
  }
  if (const auto parts = running_parts()) {
    parts->renew();
  }
}

std::shared_ptr<SharedParts> Attempt::running_parts() {
  const std::lock_guard<std::mutex> guard(parts_mutex_);
  return parts_;
}

void Attempt::ask_to_stop() {
  const FaultScope scope(lease_);
  stopping_ = true;
  stop_.request_stop();
}

void Attempt::hand_back() {
  const FaultScope scope(lease_);
  lost_ = true;
  stop_.request_stop();
  if (const auto parts = running_parts()) {
    parts->put_back();
  }
  const Result<LeaseStatus> released = context_.store.release(lease_);
  ended(released, "released");
  announce(released);
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
  ended(written, "succeeded");
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
      ended(asked, "cancelled");
      announce(asked);
      return;
    }
    if (stopping_) {
      const Result<LeaseStatus> released = context_.store.release(lease_);
      ended(released, "released");
      announce(released);
      return;
    }
  }
  Error shown = error;
  if (too_long_ && error.code == ErrorCode::Cancelled) {
    shown = {ErrorCode::LimitExceeded,
             "The job ran longer than a job may " + naming_budget("job_seconds", context_.budgets.job_seconds) + ".",
             {}};
  }
  AttemptFailure failure;
  failure.retryable = is_retryable(error);
  failure.problem_json =
      options_.problem_document ? options_.problem_document(shown) : plain_problem(shown, failure.retryable);
  store_failure(failure);
}

void Attempt::break_off(const Error& error) {
  (void)guarded_round("attempt", [&] {
    tell_escape("attempt at " + job_.id, error.message);
    if (!settled_) {
      AttemptFailure failure;
      failure.retryable = is_retryable(error);
      failure.problem_json = plain_problem(error, failure.retryable);
      store_failure(failure);
    }
  });
}

bool Attempt::is_retryable(const Error& error) const {
  return out_of_memory_ || error.code == ErrorCode::Io || error.code == ErrorCode::DiskFull;
}

void Attempt::store_failure(const AttemptFailure& failure) {
  // Where even this cannot be written, the lease runs out and the job is tried again.
  const Result<LeaseStatus> failed = context_.store.fail_attempt(lease_, failure);
  const bool dead = failed && failed->dead;
  ended(failed, dead ? "dead" : failure.retryable ? "retried" : "failed");
  announce(failed);
}

void Attempt::ended(const Result<LeaseStatus>& written, std::string_view outcome) {
  settled_ = true;
  if (options_.attempt_ended) {
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun_).count();
    options_.attempt_ended(job_.kind, written && written->held ? outcome : "lost", seconds);
  }
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
