/// The threads that help a worker compute: their faults are its job's, and there are never more than the daemon has.
#include "server/jobs/fault_recorder.hpp"
#include "server/jobs/worker_pool.hpp"
#include "tests/unit/jobs/toy_world.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <csignal>
#include <future>
#include <latch>
#include <stdexcept>
#include <thread>

namespace driftlab::server {
namespace {

using testing::HasSubstr;

/// Calls `helped` in a thread that helps the calling one, which waits for it.
void in_a_helping_thread(const RunControl& control, const std::function<void()>& helped) {
  const auto caller = std::this_thread::get_id();
  std::latch both(2);
  parallel_for(control.threads, 2, [&](std::size_t) {
    both.arrive_and_wait();
    if (std::this_thread::get_id() != caller) {
      helped();
    }
  });
}

TEST(WorkerPool, AnExceptionInAThreadThatHelpsAJobEndsTheAttemptAndNotTheDaemon) {
  // The threads that an outage evaluation started beside its worker let exceptions through: the daemon ended, charged
  // no attempt, and began the same job again after the restart.
  std::atomic<int> tries{0};
  ToyWorld world([&](const RunControl& control) -> Result<JobResults> {
    if (++tries == 1) {
      in_a_helping_thread(control, [] { throw std::runtime_error("a helper broke off"); });
    }
    return document();
  });
  const std::string thrown = world.add_toy("1");
  WorkerOptions options = ToyWorld::quiet();
  options.computing = 2;
  const auto pool = world.pool(options);
  pool->start();
  EXPECT_THAT(world.wait_for_state(thrown, JobState::Failed).problem_json, HasSubstr("a helper broke off"));
  const std::string fine = world.add_toy("2");
  pool->wake();
  world.wait_for_state(fine, JobState::Succeeded);
}

TEST(WorkerPool, AFaultInAThreadThatHelpsAJobIsChargedToThatJob) {
  // A fault in such a thread left no line either, for only the worker's own thread was marked: a crash loop.
  ToyWorld world([](const RunControl&) -> Result<JobResults> { return document(); });
  const std::string first = world.add_toy("1");
  const std::string second = world.add_toy("2");
  const auto path = world.directory.path();
  world.store.reset();
  world.blobs.reset();
  EXPECT_EXIT(
      {
        world.store = std::move(open_sqlite_store(path, world.clock).value());
        world.blobs = std::move(open_blob_directory(path).value());
        (void)install_fault_recorder(path / "faults");
        int run = 0;
        ToyKind kind([&](const RunControl& control) -> Result<JobResults> {
          in_a_helping_thread(control, [&] {
            if (++run == 2) {
              (void)std::raise(SIGSEGV);
            };
          });
          return document();
        });
        WorkerOptions options = ToyWorld::quiet();
        options.computing = 2;
        WorkerPool pool(world.context(), options, {}, [&](std::string_view) { return &kind; });
        pool.start();
        std::promise<void> never;
        never.get_future().wait_for(std::chrono::seconds(20));
      },
      testing::KilledBySignal(SIGSEGV), "");
  const auto faults = take_recorded_faults(path / "faults");
  ASSERT_TRUE(faults);
  ASSERT_EQ(faults->size(), 1U);
  // Both were queued at one moment, so that their ids decide which ran first and ended well.
  world.store = std::move(open_sqlite_store(path, world.clock).value());
  const auto state_of = [&](const std::string& id) { return world.store->job(id).value().state; };
  const bool in_order = state_of(first) == JobState::Succeeded;
  EXPECT_EQ(state_of(in_order ? first : second), JobState::Succeeded);
  EXPECT_EQ(faults->front().job_id, in_order ? second : first);
  EXPECT_EQ(faults->front().attempt, 1);
}

TEST(WorkerPool, JobsThatForkNeverComputeOnMoreThreadsThanTheDaemonHas) {
  std::atomic<int> inside{0};
  std::atomic<int> most{0};
  ToyWorld world([&](const RunControl& control) -> Result<JobResults> {
    parallel_for(control.threads, 200, [&](std::size_t) {
      const int now = ++inside;
      for (int seen = most; now > seen && !most.compare_exchange_weak(seen, now);) {
      }
      std::this_thread::yield();
      --inside;
    });
    return document();
  });
  std::vector<std::string> jobs;
  for (int i = 0; i < 8; ++i) {
    jobs.push_back(world.add_toy(std::to_string(i)));
  }
  WorkerOptions options = ToyWorld::quiet(4);
  options.computing = 3;
  const auto pool = world.pool(options);
  pool->start();
  for (const std::string& id : jobs) {
    world.wait_for_state(id, JobState::Succeeded);
  }
  EXPECT_LE(most, 3);
}

}  // namespace
}  // namespace driftlab::server
