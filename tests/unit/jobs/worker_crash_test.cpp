/// kill -9 while jobs run.
#include "server/jobs/worker_pool.hpp"
#include "server/store/crash_point.hpp"
#include "tests/unit/jobs/toy_world.hpp"

#include <gtest/gtest.h>

#include <csignal>
#include <string_view>

namespace driftlab::server {
namespace {

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
