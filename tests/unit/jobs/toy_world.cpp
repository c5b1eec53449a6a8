#include "tests/unit/jobs/toy_world.hpp"

namespace driftlab::server {

void Gate::open() {
  {
    const std::lock_guard<std::mutex> guard(mutex_);
    open_ = true;
  }
  opened_.notify_all();
}

bool Gate::pass(const std::stop_token& stop) {
  std::unique_lock<std::mutex> guard(mutex_);
  return opened_.wait(guard, stop, [this] { return open_; });
}

ToyWorld::ToyWorld(ToyWork work, const SqliteOptions& options) : kind(std::move(work)) {
  SqliteOptions seeded = options;
  seeded.jitter_seed = 1;
  store = std::move(open_sqlite_store(directory.path(), clock, seeded).value());
  blobs = std::move(open_blob_directory(directory.path()).value());
}

WorkerOptions ToyWorld::quiet(int threads) {
  WorkerOptions options;
  options.threads = threads;
  options.renew_micros = kHour;
  options.maintain = false;
  return options;
}

std::unique_ptr<WorkerPool> ToyWorld::pool(WorkerOptions options) {
  return pool_of(std::move(options),
                 [this](std::string_view name) -> const JobKind* { return name == kind.name() ? &kind : nullptr; });
}

std::unique_ptr<WorkerPool> ToyWorld::pool_of(WorkerOptions options, JobKindLookup kinds) {
  return std::make_unique<WorkerPool>(
      context(), std::move(options), [this](const std::string& id) { changed(id); }, std::move(kinds));
}

std::string ToyWorld::add_toy(const std::string& key) {
  const auto job = store->enqueue({"toy", key, "{}"});
  EXPECT_TRUE(job && job->created);
  return job->job.id;
}

void ToyWorld::changed(const std::string& id) {
  {
    const std::lock_guard<std::mutex> guard(mutex_);
    changes_.push_back(id);
  }
  changed_.notify_all();
}

std::vector<std::string> ToyWorld::changes() {
  const std::lock_guard<std::mutex> guard(mutex_);
  return changes_;
}

Job ToyWorld::wait_for(const std::string& id, const std::function<bool(const Job&)>& condition) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  std::unique_lock<std::mutex> guard(mutex_);
  while (true) {
    const std::size_t seen = changes_.size();
    guard.unlock();
    const Result<Job> job = store->job(id);
    EXPECT_TRUE(job);
    if (condition(*job)) {
      return *job;
    }
    guard.lock();
    if (!changed_.wait_until(guard, deadline, [&] { return changes_.size() != seen; })) {
      ADD_FAILURE() << "the job stays " << name_of(job->state) << " at " << job->stage;
      return *job;
    }
  }
}

Job ToyWorld::wait_for_state(const std::string& id, JobState state) {
  return wait_for(id, [state](const Job& job) { return job.state == state; });
}

}  // namespace driftlab::server
