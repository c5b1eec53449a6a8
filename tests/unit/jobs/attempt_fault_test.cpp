/// A job whose failure could not be put into words, or whose end could not be told, ended the daemon and was charged
/// for nothing: only its work was watched. It ran again after every start and brought the daemon down each time.
#include "server/jobs/fault_recorder.hpp"
#include "server/jobs/worker_pool.hpp"
#include "server/store/guarded_round.hpp"
#include "tests/unit/jobs/toy_world.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <functional>
#include <memory>
#include <stdexcept>
#include <thread>
#include <utility>

namespace driftlab::server {
namespace {

using testing::HasSubstr;
using testing::SizeIs;

/// What runs on behalf of a job beside its work.
enum class Part { ToldOfClaim, ProblemWritten, ToldOfEnd };

Result<JobResults> fail_at_once(const RunControl& /*control*/) { return fail(ErrorCode::InvalidArgument, "NaN."); }

/// A pool of one worker that calls `happens` in that part of its first attempt, and `changed` after.
std::unique_ptr<WorkerPool> pool_where(ToyWorld& world, Part part, std::function<void()> happens,
                                       std::function<void(const std::string&)> changed) {
  const auto once = [happens = std::move(happens), done = std::make_shared<std::atomic<bool>>(false)] {
    if (!done->exchange(true)) {
      happens();
    }
  };
  WorkerOptions options = ToyWorld::quiet();
  if (part == Part::ProblemWritten) {
    options.problem_document = [once](const Error& error) {
      once();
      return "[" + error.message + "]";
    };
  }
  if (part == Part::ToldOfEnd) {
    options.attempt_ended = [once](std::string_view, std::string_view, double) { once(); };
  }
  auto told = [once, part, changed = std::move(changed)](const std::string& id) {
    if (part == Part::ToldOfClaim) {
      once();
    }
    changed(id);
  };
  return std::make_unique<WorkerPool>(
      world.context(), std::move(options), std::move(told),
      [&world](std::string_view name) -> const JobKind* { return name == world.kind.name() ? &world.kind : nullptr; });
}

/// The job once it is in that state; its end may be told to nobody.
Job wait_until(ToyWorld& world, const std::string& id, JobState state) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  while (world.store->job(id)->state != state && std::chrono::steady_clock::now() < deadline) {
    std::this_thread::yield();
  }
  return *world.store->job(id);
}

class AttemptFault : public testing::TestWithParam<Part> {};

TEST_P(AttemptFault, ASignalIsChargedToTheAttempt) {
  ToyWorld world(fail_at_once);
  const std::string id = world.add_toy();
  const auto path = world.directory.path();
  world.store.reset();
  world.blobs.reset();
  EXPECT_EXIT(
      {
        world.store = std::move(open_sqlite_store(path, world.clock).value());
        world.blobs = std::move(open_blob_directory(path).value());
        (void)install_fault_recorder(path / "faults").has_value();
        const auto pool = pool_where(world, GetParam(), [] { (void)std::raise(SIGSEGV); }, [](const std::string&) {});
        pool->start();
        wait_until(world, id, JobState::Dead);
      },
      testing::KilledBySignal(SIGSEGV), "");
  const auto faults = take_recorded_faults(path / "faults");
  ASSERT_TRUE(faults);
  ASSERT_THAT(*faults, SizeIs(1));
  EXPECT_EQ(faults->front().job_id, id);
  EXPECT_EQ(faults->front().attempt, 1);
}

TEST_P(AttemptFault, AnExceptionIsItsFailureAndTheWorkerGoesOn) {
  std::atomic<int> told{0};
  tell_escapes_to([&](std::string_view, std::string_view what) {
    EXPECT_EQ(what, "The job broke off: no room for it.");
    ++told;
  });
  ToyWorld world(fail_at_once);
  const auto pool =
      pool_where(world, GetParam(), [] { throw std::runtime_error("no room for it"); }, [](const std::string&) {});
  pool->start();
  const std::string broken = world.add_toy("first");
  pool->wake();
  const Job job = wait_until(world, broken, JobState::Failed);
  EXPECT_EQ(job.state, JobState::Failed);
  EXPECT_EQ(job.failures, 1) << "charged once";
  // An attempt whose failure was stored before keeps that.
  EXPECT_THAT(job.problem_json, HasSubstr(GetParam() == Part::ToldOfEnd ? "NaN." : "no room for it"));
  const std::string next = world.add_toy("second");
  pool->wake();
  EXPECT_EQ(wait_until(world, next, JobState::Failed).failures, 1);
  pool->stop();
  tell_escapes_to({});
  EXPECT_EQ(told, 1);
}

INSTANTIATE_TEST_SUITE_P(Parts, AttemptFault, testing::Values(Part::ToldOfClaim, Part::ProblemWritten, Part::ToldOfEnd),
                         [](const auto& part) {
                           return part.param == Part::ToldOfClaim      ? "ToldOfClaim"
                                  : part.param == Part::ProblemWritten ? "ProblemWritten"
                                                                       : "ToldOfEnd";
                         });

TEST(Attempt, AnExceptionAfterASuccessLeavesTheSuccess) {
  ToyWorld world(succeed_at_once);
  const auto pool =
      pool_where(world, Part::ToldOfEnd, [] { throw std::runtime_error("no room for it"); }, [](const std::string&) {});
  pool->start();
  const std::string id = world.add_toy();
  pool->wake();
  EXPECT_EQ(wait_until(world, id, JobState::Succeeded).failures, 0);
  pool->stop();
  EXPECT_EQ(world.store->job(id)->state, JobState::Succeeded);
}

TEST(FaultScope, AfterAnInnerScopeTheOuterIsChargedAgain) {
  const TemporaryDirectory folder;
  const auto file = folder.path() / "faults";
  const Lease outer{make_id("job", 1), 3};
  EXPECT_EXIT(
      {
        (void)install_fault_recorder(file).has_value();
        const FaultScope scope(outer);
        {
          const FaultScope inner(Lease{make_id("job", 2), 1});
        }
        (void)std::raise(SIGFPE);
      },
      testing::KilledBySignal(SIGFPE), "");
  const auto faults = take_recorded_faults(file);
  ASSERT_TRUE(faults && faults->size() == 1U);
  EXPECT_EQ(faults->front().job_id, outer.job_id);
}

}  // namespace
}  // namespace driftlab::server
