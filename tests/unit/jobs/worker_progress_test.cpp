/// How often a job's progress is written down.
#include "server/jobs/worker_pool.hpp"
#include "tests/unit/jobs/toy_world.hpp"

#include <gtest/gtest.h>

#include <future>

namespace driftlab::server {
namespace {

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

}  // namespace
}  // namespace driftlab::server
