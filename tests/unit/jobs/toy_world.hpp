#pragma once
/// A store, a blob directory, a clock and toy kinds of job, to test the workers without numbers.
#include "server/jobs/worker_pool.hpp"
#include "server/store/sqlite/sqlite_store.hpp"
#include "tests/unit/store/world.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace driftlab::server {

using ToyWork = std::function<Result<JobResults>(const RunControl& control)>;

[[nodiscard]] inline JobResults document(const std::string& text = R"({"done":true})") { return {text, {}, {}}; }

[[nodiscard]] inline Result<JobResults> succeed_at_once(const RunControl& /*control*/) { return document(); }

/// A kind whose work is a function.
class ToyKind final : public JobKind {
 public:
  explicit ToyKind(ToyWork work) : work_(std::move(work)) {}
  [[nodiscard]] std::string_view name() const override { return "toy"; }
  [[nodiscard]] Result<Json> canonical_request(const Json& inputs, const Json& /*parameters*/,
                                               JobContext& /*context*/) const override {
    return inputs;
  }
  [[nodiscard]] Result<JobResults> run(const Json& /*request*/, JobContext& /*context*/,
                                       const RunControl& control) const override {
    return work_(control);
  }

 private:
  ToyWork work_;
};

/// Blocks a thread until another opens it, or until its stop token is raised.
class Gate {
 public:
  void open();
  /// False: stopped before it opened.
  bool pass(const std::stop_token& stop = {});

 private:
  std::mutex mutex_;
  std::condition_variable_any opened_;
  bool open_ = false;
};

class ToyWorld {
 public:
  explicit ToyWorld(ToyWork work, const SqliteOptions& options = {});

  [[nodiscard]] JobContext context() { return {*store, *blobs, clock}; }
  /// A pool whose heart beats only when woken, unless `options` says otherwise.
  std::unique_ptr<WorkerPool> pool(WorkerOptions options);
  /// The same with kinds of one's own.
  std::unique_ptr<WorkerPool> pool_of(WorkerOptions options, JobKindLookup kinds);
  static WorkerOptions quiet(int threads = 1);

  std::string add_toy(const std::string& key = "key");
  /// Waits until the job satisfies `condition`, looking after every change. Fails after 20 s.
  Job wait_for(const std::string& id, const std::function<bool(const Job&)>& condition);
  Job wait_for_state(const std::string& id, JobState state);
  std::vector<std::string> changes();

  TemporaryDirectory directory;
  FakeClock clock;
  std::unique_ptr<SqliteStore> store;
  std::unique_ptr<BlobStore> blobs;
  ToyKind kind;

 private:
  void changed(const std::string& id);

  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<std::string> changes_;
};

}  // namespace driftlab::server
