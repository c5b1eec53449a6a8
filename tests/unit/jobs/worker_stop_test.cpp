/// What ends a running job before its work is done: a cancel, a stop of the daemon, a lost lease.
#include "server/jobs/worker_pool.hpp"
#include "tests/unit/jobs/toy_world.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <thread>

namespace driftlab::server {
namespace {

/// Reports once and then waits to be stopped.
Result<JobResults> wait_for_stop(const RunControl& control) {
  control.report("waiting", 0.1);
  Gate never;
  never.pass(control.stop);
  return fail(ErrorCode::Cancelled, "Stopped on request.");
}

TEST(WorkerPool, WorkThatLearnsByItselfThatNobodyWantsItIsCancelled) {
  // A pooling that found newer results before the heartbeat had told it was written down as failed.
  ToyWorld* here = nullptr;
  std::string id;
  ToyWorld world([&](const RunControl&) -> Result<JobResults> {
    EXPECT_TRUE(here->store->request_cancel(id));
    return fail(ErrorCode::Cancelled, "Another job does this better.");
  });
  here = &world;
  id = world.add_toy();
  const auto pool = world.pool(ToyWorld::quiet());
  pool->start();
  EXPECT_EQ(world.wait_for(id, [](const Job& job) { return is_terminal(job.state); }).state, JobState::Cancelled);
}

TEST(WorkerPool, ACancelReachesARunningJobAtOnce) {
  ToyWorld world(wait_for_stop);
  const std::string id = world.add_toy();
  const auto pool = world.pool(ToyWorld::quiet());
  pool->start();
  world.wait_for(id, [](const Job& job) { return job.stage == "waiting"; });
  EXPECT_EQ(pool->busy(), 1);
  ASSERT_TRUE(world.store->request_cancel(id));
  pool->wake();
  const Job job = world.wait_for_state(id, JobState::Cancelled);
  EXPECT_EQ(job.failures, 0);
  EXPECT_EQ(job.problem_json, "");
}

TEST(WorkerPool, AResultThatIsReadyWinsOverACancel) {
  Gate finish;
  ToyWorld world([&](const RunControl& control) -> Result<JobResults> {
    control.report("last step", 0.9);
    finish.pass();
    return document();
  });
  const std::string id = world.add_toy();
  const auto pool = world.pool(ToyWorld::quiet());
  pool->start();
  world.wait_for(id, [](const Job& job) { return job.stage == "last step"; });
  ASSERT_TRUE(world.store->request_cancel(id));
  pool->wake();
  finish.open();
  world.wait_for_state(id, JobState::Succeeded);
}

TEST(WorkerPool, WorkThatGivesUpUnaskedHasFailed) {
  ToyWorld world([](const RunControl&) -> Result<JobResults> { return fail(ErrorCode::Cancelled, "Why?"); });
  const std::string id = world.add_toy();
  const auto pool = world.pool(ToyWorld::quiet());
  pool->start();
  world.wait_for_state(id, JobState::Failed);
}

TEST(WorkerPool, StopHandsRunningJobsBackUnpunished) {
  ToyWorld world(wait_for_stop);
  const std::string id = world.add_toy();
  const auto pool = world.pool(ToyWorld::quiet());
  pool->start();
  world.wait_for(id, [](const Job& job) { return job.stage == "waiting"; });
  pool->stop();
  pool->stop();
  const auto job = world.store->job(id);
  EXPECT_EQ(job->state, JobState::Queued);
  EXPECT_EQ(job->failures, 0);
  EXPECT_EQ(job->attempt, 1);
}

TEST(WorkerPool, AJobThatDoesNotStopInTimeIsHandedBackAndItsResultDiscarded) {
  Gate finish;
  ToyWorld world([&](const RunControl& control) -> Result<JobResults> {
    control.report("deaf", 0.1);
    finish.pass();
    return document();
  });
  const std::string id = world.add_toy();
  WorkerOptions options = ToyWorld::quiet();
  options.grace_micros = 1000;
  const auto pool = world.pool(options);
  pool->start();
  world.wait_for(id, [](const Job& job) { return job.stage == "deaf"; });
  std::thread stopping([&] { pool->stop(); });
  world.wait_for_state(id, JobState::Queued);
  finish.open();
  stopping.join();
  EXPECT_EQ(world.store->job(id)->state, JobState::Queued);
  EXPECT_FALSE(world.store->result_document(id));
}

TEST(WorkerPool, TheHeartbeatKeepsALeaseAlive) {
  ToyWorld world(wait_for_stop);
  const std::string id = world.add_toy();
  WorkerOptions options = ToyWorld::quiet();
  options.renew_micros = 500;
  const auto pool = world.pool(options);
  pool->start();
  world.wait_for(id, [](const Job& job) { return job.stage == "waiting"; });
  for (int i = 0; i < 3; ++i) {
    world.clock.advance(options.lease_micros - 1);
    const UtcMicros renewed = world.clock.now() + options.lease_micros;
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    while (world.store->job(id)->lease_expires_at != renewed && std::chrono::steady_clock::now() < deadline) {
      std::this_thread::yield();
    }
    EXPECT_EQ(world.store->job(id)->lease_expires_at, renewed);
    EXPECT_EQ(*world.store->rescue_expired(), 0);
  }
}

TEST(WorkerPool, AWorkerWhoseLeaseWasLostStopsAndWritesNothing) {
  Gate stopped;
  ToyWorld world([&](const RunControl& control) -> Result<JobResults> {
    control.report("waiting", 0.1);
    Gate never;
    never.pass(control.stop);
    control.report("after the loss", 0.9);
    stopped.open();
    return document(R"("of the first worker")");
  });
  const std::string id = world.add_toy();
  const auto pool = world.pool(ToyWorld::quiet());
  pool->start();
  world.wait_for(id, [](const Job& job) { return job.stage == "waiting"; });
  world.clock.advance(ToyWorld::quiet().lease_micros);
  ASSERT_EQ(*world.store->rescue_expired(), 1);
  const Job second = claim_one(*world.store);
  ASSERT_EQ(second.id, id);
  pool->wake();
  stopped.pass();
  pool->stop();
  EXPECT_EQ(world.store->job(id)->stage, "");
  EXPECT_TRUE(world.store->succeed(lease_of(second), document(R"("of the second worker")"))->held);
  EXPECT_EQ(*world.store->result_document(id), R"("of the second worker")");
}

}  // namespace
}  // namespace driftlab::server
