#include "server/jobs/worker_pool.hpp"

#include "server/store/retry_policy.hpp"
#include "tests/unit/jobs/toy_world.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <latch>
#include <new>
#include <thread>

namespace driftlab::server {
namespace {

using testing::HasSubstr;

TEST(WorkerPool, RunsAQueuedJobAndStoresItsResult) {
  ToyWorld world([](const RunControl& control) -> Result<JobResults> {
    control.report("variance", 0.5);
    return document();
  });
  const std::string id = world.add_toy();
  const auto pool = world.pool(ToyWorld::quiet());
  pool->start();
  world.wait_for_state(id, JobState::Succeeded);
  pool->stop();
  EXPECT_EQ(*world.store->result_document(id), R"({"done":true})");
  const auto events = world.store->events_after(id, 0, 100);
  ASSERT_EQ(events->size(), 4U);  // queued, running, variance, succeeded
  EXPECT_EQ((*events)[2].stage, "variance");
  EXPECT_EQ(world.changes(), std::vector<std::string>(3, id)) << "one call for each event of the workers";
}

TEST(WorkerPool, AnIdleWorkerWakesForANewJob) {
  ToyWorld world(succeed_at_once);
  WorkerOptions options = ToyWorld::quiet(2);
  options.idle_micros = kHour;
  const auto pool = world.pool(options);
  pool->start();
  for (int i = 0; i < 5; ++i) {
    const std::string id = world.add_toy(std::to_string(i));
    pool->wake();
    world.wait_for_state(id, JobState::Succeeded);
  }
}

TEST(WorkerPool, AnIdleWorkerLooksByItself) {
  ToyWorld world(succeed_at_once);
  WorkerOptions options = ToyWorld::quiet();
  options.idle_micros = 1000;
  const auto pool = world.pool(options);
  pool->start();
  world.wait_for_state(world.add_toy(), JobState::Succeeded);
}

TEST(WorkerPool, RunsAsManyJobsAtOnceAsItHasThreads) {
  std::atomic<int> inside{0};
  Gate both;
  ToyWorld world([&](const RunControl&) -> Result<JobResults> {
    if (++inside == 2) {
      both.open();
    }
    both.pass();
    return document();
  });
  const std::string first = world.add_toy("first");
  const std::string second = world.add_toy("second");
  const auto pool = world.pool(ToyWorld::quiet(2));
  EXPECT_EQ(pool->busy(), 0);
  pool->start();
  world.wait_for_state(first, JobState::Succeeded);
  world.wait_for_state(second, JobState::Succeeded);
  pool->stop();
  EXPECT_EQ(pool->busy(), 0);
}

TEST(WorkerPool, AFinalFailureKeepsItsProblem) {
  ToyWorld world([](const RunControl&) -> Result<JobResults> {
    return fail(ErrorCode::TooFewSamples, "One sample is too few.", {{"column", "gz"}});
  });
  const std::string id = world.add_toy();
  const auto pool = world.pool(ToyWorld::quiet());
  pool->start();
  const Job job = world.wait_for_state(id, JobState::Failed);
  EXPECT_THAT(job.problem_json, HasSubstr(R"("code":"too_few_samples")"));
  EXPECT_THAT(job.problem_json, HasSubstr("One sample is too few."));
  EXPECT_THAT(job.problem_json, HasSubstr(R"("column":"gz")"));
  EXPECT_THAT(job.problem_json, HasSubstr(R"("retryable":false)"));
}

TEST(WorkerPool, TheDaemonMayWriteTheProblemDocument) {
  ToyWorld world([](const RunControl&) -> Result<JobResults> { return fail(ErrorCode::NonFinite, "NaN."); });
  const std::string id = world.add_toy();
  WorkerOptions options = ToyWorld::quiet();
  options.problem_document = [](const Error& error) { return "[" + error.message + "]"; };
  const auto pool = world.pool(options);
  pool->start();
  EXPECT_EQ(world.wait_for_state(id, JobState::Failed).problem_json, "[NaN.]");
}

TEST(WorkerPool, ARetryableFailureIsTriedAgainAfterItsPause) {
  std::atomic<int> tries{0};
  ToyWorld world([&](const RunControl&) -> Result<JobResults> {
    if (++tries == 1) {
      return fail(ErrorCode::Io, "The disk did not answer.");
    }
    return document();
  });
  const std::string id = world.add_toy();
  const auto pool = world.pool(ToyWorld::quiet());
  pool->start();
  const Job failed = world.wait_for(id, [](const Job& job) { return job.failures == 1; });
  EXPECT_EQ(failed.state, JobState::Queued);
  world.clock.advance(kLongestPauseMicros);
  pool->wake();
  const Job done = world.wait_for_state(id, JobState::Succeeded);
  EXPECT_EQ(done.attempt, 2);
  EXPECT_EQ(done.attempt_problems_json.size(), 1U);
  EXPECT_EQ(tries, 2);
}

TEST(WorkerPool, ExceptionsEndTheAttemptAndNotTheWorker) {
  std::atomic<int> tries{0};
  ToyWorld world([&](const RunControl&) -> Result<JobResults> {
    switch (++tries) {
      case 1:
        throw std::runtime_error("unexpected");
      case 2:
        throw 42;  // NOLINT: the point
      case 3:
        throw std::bad_alloc();
      default:
        return document();
    }
  });
  const std::string thrown = world.add_toy("1");
  const auto pool = world.pool(ToyWorld::quiet());
  pool->start();
  const Job job = world.wait_for_state(thrown, JobState::Failed);
  EXPECT_THAT(job.problem_json, HasSubstr("unexpected"));
  EXPECT_THAT(job.problem_json, HasSubstr(R"("code":"internal")"));
  const std::string odd = world.add_toy("2");
  pool->wake();
  world.wait_for_state(odd, JobState::Failed);
  const std::string memory = world.add_toy("3");
  pool->wake();
  EXPECT_EQ(world.wait_for(memory, [](const Job& j) { return j.failures == 1; }).state, JobState::Queued);
  const std::string fine = world.add_toy("4");
  pool->wake();
  world.wait_for_state(fine, JobState::Succeeded);
}

TEST(WorkerPool, AnUnknownKindFailsForGood) {
  ToyWorld world(succeed_at_once);
  const auto job = world.store->enqueue({"of another release", "key", "{}"});
  const auto pool = world.pool(ToyWorld::quiet());
  pool->start();
  EXPECT_THAT(world.wait_for_state(job->job.id, JobState::Failed).problem_json, HasSubstr("of another release"));
}

TEST(WorkerPool, AResultThatHasNoRoomOnDiskIsARetryableFailure) {
  SqliteOptions small;
  small.max_pages = 100;
  ToyWorld world([](const RunControl&) -> Result<JobResults> { return document(std::string(1'000'000, 'x')); }, small);
  const std::string id = world.add_toy();
  const auto pool = world.pool(ToyWorld::quiet());
  pool->start();
  const Job job = world.wait_for(id, [](const Job& j) { return j.failures == 1; });
  EXPECT_EQ(job.state, JobState::Queued);
  EXPECT_THAT(job.problem_json, HasSubstr("disk_full"));
}

TEST(WorkerPool, APoolThatNeverStartedStops) {
  ToyWorld world(succeed_at_once);
  const std::string id = world.add_toy();
  const auto pool = world.pool(ToyWorld::quiet());
  pool->stop();
  EXPECT_EQ(pool->busy(), 0);
  EXPECT_EQ(world.store->job(id)->state, JobState::Queued);
}

}  // namespace
}  // namespace driftlab::server
