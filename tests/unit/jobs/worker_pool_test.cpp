#include "server/jobs/worker_pool.hpp"

#include "server/jobs/fault_recorder.hpp"
#include "server/store/crash_point.hpp"
#include "server/store/retry_policy.hpp"
#include "tests/unit/jobs/toy_world.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <csignal>
#include <future>
#include <latch>
#include <new>
#include <thread>

namespace driftlab::server {
namespace {

using testing::HasSubstr;

JobResults document(const std::string& text = R"({"done":true})") { return {text, {}, {}}; }

Result<JobResults> succeed_at_once(const RunControl& /*control*/) { return document(); }

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

TEST(WorkerPool, AnUnknownKindFailsForGood) {
  ToyWorld world(succeed_at_once);
  const auto job = world.store->enqueue({"of another release", "key", "{}"});
  const auto pool = world.pool(ToyWorld::quiet());
  pool->start();
  EXPECT_THAT(world.wait_for_state(job->job.id, JobState::Failed).problem_json, HasSubstr("of another release"));
}

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

int progress_events(ToyWorld& world, const std::string& id) {
  int count = 0;
  const auto events = world.store->events_after(id, 0, 10'000);
  for (const JobEvent& event : *events) {
    count += event.type == "progress" ? 1 : 0;
  }
  return count;
}

TEST(WorkerPool, ProgressIsThinnedOutAcrossStages) {
  ToyWorld world([](const RunControl& control) -> Result<JobResults> {
    for (int i = 0; i < 300; ++i) {
      control.report("stage " + std::to_string(i / 100), i / 300.0);
    }
    return document();
  });
  WorkerOptions options = ToyWorld::quiet();
  options.progress_micros = kHour;
  const std::string id = world.add_toy();
  const auto pool = world.pool(options);
  pool->start();
  world.wait_for_state(id, JobState::Succeeded);
  EXPECT_EQ(progress_events(world, id), 1);
}

TEST(WorkerPool, AThinnedOutStageIsToldLaterWhereTheJobSaysNothingMore) {
  std::promise<void> told;
  ToyWorld world([&](const RunControl& control) -> Result<JobResults> {
    control.report("first", 0.0);
    control.report("long and silent", 0.5);
    told.get_future().wait();
    return document();
  });
  WorkerOptions options = ToyWorld::quiet();
  options.progress_micros = 50'000;
  const std::string id = world.add_toy();
  const auto pool = world.pool(options);
  pool->start();
  const Job job = world.wait_for(id, [](const Job& j) { return j.stage == "long and silent"; });
  EXPECT_EQ(job.state, JobState::Running);
  told.set_value();
  world.wait_for_state(id, JobState::Succeeded);
}

TEST(WorkerPool, EveryReportIsToldWhereNothingIsThinnedOut) {
  ToyWorld world([](const RunControl& control) -> Result<JobResults> {
    for (int i = 0; i < 20; ++i) {
      control.report("one stage", i / 20.0);
    }
    return document();
  });
  WorkerOptions options = ToyWorld::quiet();
  options.progress_micros = 0;
  const std::string id = world.add_toy();
  const auto pool = world.pool(options);
  pool->start();
  world.wait_for_state(id, JobState::Succeeded);
  EXPECT_EQ(progress_events(world, id), 20);
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

/// kill -9 at every point of a job's life, then a restart: the job is still there and its result appears once.
class JobCrash : public testing::TestWithParam<std::string_view> {};

TEST_P(JobCrash, LosesNothingAndFinishesOnce) {
  ToyWorld world([](const RunControl& control) -> Result<JobResults> {
    control.report("variance", 0.5);
    return document();
  });
  const std::string id = world.add_toy();
  const auto path = world.directory.path();
  world.store.reset();
  world.blobs.reset();
  EXPECT_EXIT(
      {
        world.store = std::move(open_sqlite_store(path, world.clock).value());
        world.blobs = std::move(open_blob_directory(path).value());
        (void)arm_crash_point(GetParam());
        const auto pool = world.pool(ToyWorld::quiet());
        pool->start();
        world.wait_for_state(id, JobState::Succeeded);
        pool->stop();
      },
      testing::KilledBySignal(SIGKILL), "");
  world.store = std::move(open_sqlite_store(path, world.clock).value());
  world.blobs = std::move(open_blob_directory(path).value());
  const bool finished = GetParam() == "job.finished";
  EXPECT_EQ(world.store->job(id)->state, finished ? JobState::Succeeded : JobState::Running);
  EXPECT_EQ(world.store->result_document(id).has_value(), finished);
  EXPECT_EQ(*world.store->end_all_leases(), finished ? 0 : 1);
  const auto pool = world.pool(ToyWorld::quiet());
  pool->start();
  const Job job = world.wait_for_state(id, JobState::Succeeded);
  EXPECT_EQ(job.attempt, finished ? 1 : 2);
  EXPECT_EQ(job.failures, 0);
  int finishes = 0;
  const auto events = world.store->events_after(id, 0, 100);
  for (const JobEvent& event : *events) {
    finishes += event.state == JobState::Succeeded ? 1 : 0;
  }
  EXPECT_EQ(finishes, 1);
}

INSTANTIATE_TEST_SUITE_P(Points, JobCrash,
                         testing::Values("job.claimed", "job.working", "job.before_finish", "job.in_finish",
                                         "job.finished"),
                         [](const auto& point) { return std::string(point.param).substr(4); });

}  // namespace
}  // namespace driftlab::server
