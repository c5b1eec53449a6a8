#include "server/jobs/worker_pool.hpp"

#include "server/jobs/attempt.hpp"
#include "server/jobs/helping.hpp"
#include "server/jobs/maintenance.hpp"
#include "server/store/guarded_round.hpp"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

namespace driftlab::server {

struct WorkerPool::Implementation {
  Implementation(JobContext job_context, WorkerOptions worker_options,
                 std::function<void(const std::string&)> on_change, JobKindLookup lookup)
      : context(std::move(job_context)),
        options(std::move(worker_options)),
        changed(std::move(on_change)),
        kinds(std::move(lookup)),
        executor(static_cast<unsigned>(options.computing > 0 ? options.computing : std::max(1, options.threads))),
        memory(memory_for_jobs(context.budgets)),
        maintenance(context.store, context.blobs, context.clock, options.maintenance, [this] { wake(); }) {}

  void start();
  void ask_to_stop();
  void stop();
  void wake();
  void work();
  void beat();
  [[nodiscard]] std::vector<std::shared_ptr<Work>> works();
  /// Runs the next job if one is due, or helps with one that runs. False: there was nothing to do, or the store did not
  /// answer.
  [[nodiscard]] bool run_next();
  [[nodiscard]] bool help();
  void carry_out(const std::shared_ptr<Work>& work);

  JobContext context;
  const WorkerOptions options;
  const std::function<void(const std::string&)> changed;
  const JobKindLookup kinds;
  Executor executor;
  MemoryGate memory;
  Maintenance maintenance;

  std::mutex mutex;
  std::condition_variable woken;    ///< workers and the heartbeat wait for it
  std::condition_variable drained;  ///< `stop` waits for it
  std::vector<std::shared_ptr<Work>> running;
  std::uint64_t wakes = 0;
  bool stopping = false;
  bool beating = true;
  std::vector<std::thread> workers;
  std::thread heart;
};

void WorkerPool::Implementation::start() {
  heart = std::thread([this] { beat(); });
  for (int i = 0; i < options.threads; ++i) {
    workers.emplace_back([this] { work(); });
  }
  if (options.maintain) {
    maintenance.start();
  }
}

void WorkerPool::Implementation::wake() {
  {
    const std::lock_guard<std::mutex> guard(mutex);
    ++wakes;
  }
  woken.notify_all();
}

std::vector<std::shared_ptr<Work>> WorkerPool::Implementation::works() {
  const std::lock_guard<std::mutex> guard(mutex);
  return running;
}

void WorkerPool::Implementation::work() {
  std::unique_lock<std::mutex> guard(mutex);
  while (!stopping) {
    const std::uint64_t seen = wakes;
    guard.unlock();
    bool worked = false;
    (void)guarded_round("worker", [&] { worked = run_next(); });
    guard.lock();
    if (!worked) {
      woken.wait_for(guard, std::chrono::microseconds(options.idle_micros),
                     [this, seen] { return stopping || wakes != seen; });
    }
  }
}

bool WorkerPool::Implementation::run_next() {
  // A store that does not answer is asked again like one that has nothing to do.
  std::optional<Job> claimed =
      context.store.claim(options.lease_micros, context.budgets.running_jobs_per_token, options.known)
          .value_or(std::nullopt);
  if (!claimed) {
    return help();
  }
  const JobKind* kind = kinds(claimed->kind);
  carry_out(std::make_shared<Attempt>(std::move(*claimed), kind, context, executor, memory, options, changed,
                                      [this] { wake(); }));
  return true;
}

bool WorkerPool::Implementation::help() {
  std::optional<Job> job = context.store.parts().job_to_help(options.known, DRIFTLAB_VERSION).value_or(std::nullopt);
  if (!job) {
    return false;
  }
  const JobKind* const kind = kinds(job->kind);
  if (kind == nullptr) {
    return false;
  }
  const auto helping = std::make_shared<Helping>(std::move(*job), *kind, context, executor, memory, options);
  carry_out(helping);
  if (options.parts_helped && helping->finished() > 0) {
    options.parts_helped(kind->name(), helping->finished());
  }
  return helping->finished() > 0;  // else there is nothing to gain by looking again at once
}

void WorkerPool::Implementation::carry_out(const std::shared_ptr<Work>& work) {
  bool too_late = false;
  {
    const std::lock_guard<std::mutex> guard(mutex);
    running.push_back(work);
    too_late = stopping;
  }
  woken.notify_all();
  if (too_late) {
    work->ask_to_stop();
  }
  (void)guarded_round("worker", [&] { work->run(); });
  {
    const std::lock_guard<std::mutex> guard(mutex);
    running.erase(std::find(running.begin(), running.end(), work));
  }
  drained.notify_all();
}

void WorkerPool::Implementation::beat() {
  const std::chrono::microseconds renewing(options.renew_micros);
  const std::chrono::microseconds telling(options.progress_micros > 0 ? options.progress_micros : options.renew_micros);
  auto renew_at = std::chrono::steady_clock::now() + renewing;
  std::unique_lock<std::mutex> guard(mutex);
  std::uint64_t seen = wakes;
  while (beating) {
    const bool idle = running.empty();
    const auto until = std::min(renew_at, std::chrono::steady_clock::now() + (idle ? renewing : telling));
    woken.wait_until(guard, until, [&] { return !beating || wakes != seen || running.empty() != idle; });
    const auto now = std::chrono::steady_clock::now();
    const bool renew = wakes != seen || now >= renew_at;
    seen = wakes;
    if (renew) {
      renew_at = now + renewing;
    }
    guard.unlock();
    (void)guarded_round("heartbeat", [&] {
      for (const auto& work : works()) {  // an exception of one leaves the others theirs
        (void)guarded_round("heartbeat", [&] { work->tend(renew); });
      }
    });
    guard.lock();
  }
}

void WorkerPool::Implementation::ask_to_stop() {
  {
    const std::lock_guard<std::mutex> guard(mutex);
    stopping = true;
  }
  woken.notify_all();
  for (const auto& work : works()) {
    work->ask_to_stop();
  }
}

void WorkerPool::Implementation::stop() {
  ask_to_stop();
  std::unique_lock<std::mutex> guard(mutex);
  drained.wait_for(guard, std::chrono::microseconds(options.grace_micros), [this] { return running.empty(); });
  guard.unlock();
  for (const auto& work : works()) {
    (void)guarded_round("hand back", [&] { work->hand_back(); });
  }
  for (std::thread& worker : workers) {
    worker.join();
  }
  workers.clear();
  guard.lock();
  beating = false;
  guard.unlock();
  woken.notify_all();
  if (heart.joinable()) {
    heart.join();
  }
  maintenance.stop();
}

WorkerPool::WorkerPool(JobContext context, WorkerOptions options,
                       std::function<void(const std::string& job_id)> changed, JobKindLookup kinds)
    : implementation_(std::make_unique<Implementation>(std::move(context), std::move(options), std::move(changed),
                                                       std::move(kinds))) {}

WorkerPool::~WorkerPool() { stop(); }

void WorkerPool::start() { implementation_->start(); }
void WorkerPool::wake() { implementation_->wake(); }
void WorkerPool::ask_to_stop() { implementation_->ask_to_stop(); }
void WorkerPool::stop() { implementation_->stop(); }

int WorkerPool::busy() const {
  const std::lock_guard<std::mutex> guard(implementation_->mutex);
  return static_cast<int>(implementation_->running.size());
}

}  // namespace driftlab::server
