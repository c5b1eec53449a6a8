#include "server/jobs/job_parts.hpp"

#include "server/store/retry_policy.hpp"
#include "tests/unit/jobs/toy_world.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <set>
#include <thread>

namespace driftlab::server {
namespace {

using testing::HasSubstr;

constexpr std::size_t kParts = 12;

std::string square(std::size_t number) { return std::to_string(number * number) + " "; }

/// Concatenates what its parts find.
class SquaresKind final : public DividedKind {
 public:
  using Compute = std::function<Result<std::string>(std::size_t number, const RunControl& control)>;
  explicit SquaresKind(Compute compute, std::size_t enough = kParts) : compute_(std::move(compute)), enough_(enough) {}
  [[nodiscard]] std::string_view name() const override { return "toy"; }
  [[nodiscard]] Result<Json> canonical_request(const Json& inputs, const Json& /*parameters*/,
                                               JobContext& /*context*/) const override {
    return inputs;
  }
  [[nodiscard]] JobCost cost(const Json& /*request*/, JobContext& /*context*/) const override {
    return {JobCost{}.memory_bytes, 10.0};
  }
  [[nodiscard]] Result<JobResults> run_in_parts(const Json& /*request*/, JobContext& /*context*/,
                                                const RunControl& control, JobParts& parts) const override {
    std::string text;
    std::size_t taken = 0;
    const auto take = [&](const std::string& found) -> Result<bool> {
      text += found;
      return ++taken < enough_;
    };
    if (auto shared = share_values<std::string>(parts, kParts, compute_, take, control); !shared) {
      return fail(shared.error());
    }
    return document(text);
  }

 private:
  Compute compute_;
  std::size_t enough_;
};

/// A world whose pools run a divided kind.
class DividedWorld : public ToyWorld {
 public:
  explicit DividedWorld(SquaresKind::Compute compute, std::size_t enough = kParts)
      : ToyWorld(succeed_at_once), divided(std::move(compute), enough) {}
  std::unique_ptr<WorkerPool> divided_pool(WorkerOptions options) {
    return pool_of(std::move(options), [this](std::string_view name) -> const JobKind* {
      return name == divided.name() ? &divided : nullptr;
    });
  }
  SquaresKind divided;
};

WorkerOptions eager(int threads) {
  WorkerOptions options = ToyWorld::quiet(threads);
  options.idle_micros = 1000;
  return options;
}

std::string expected(std::size_t parts = kParts) {
  std::string text;
  for (std::size_t i = 0; i < parts; ++i) {
    text += square(i);
  }
  return text;
}

Result<std::string> slow_square(std::size_t number, const RunControl& /*control*/) {
  std::this_thread::sleep_for(std::chrono::milliseconds((number * 7) % 5));
  return square(number);
}

TEST(JobParts, TheResultIsTheSameForAnyNumberOfWorkersAndProcesses) {
  for (const int pools : {1, 3}) {
    for (const int threads : {1, 4}) {
      DividedWorld world(slow_square);
      const std::string id = world.add_toy();
      std::vector<std::unique_ptr<WorkerPool>> running;
      for (int i = 0; i < pools; ++i) {
        running.push_back(world.divided_pool(eager(threads)));
        running.back()->start();
      }
      world.wait_for_state(id, JobState::Succeeded);
      EXPECT_EQ(*world.store->result_document(id), expected()) << pools << " pools of " << threads;
    }
  }
}

TEST(JobParts, IdleWorkersHelp) {
  std::mutex mutex;
  std::set<std::thread::id> threads;
  Gate both;
  DividedWorld world([&](std::size_t number, const RunControl& control) -> Result<std::string> {
    {
      const std::lock_guard<std::mutex> guard(mutex);
      threads.insert(std::this_thread::get_id());
      if (threads.size() == 2) {
        both.open();
      }
    }
    both.pass(control.stop);  // nobody gets on alone
    return square(number);
  });
  const std::string id = world.add_toy();
  WorkerOptions options = ToyWorld::quiet(2);
  options.idle_micros = kHour;  // a worker that sleeps is woken for parts
  const auto pool = world.divided_pool(options);
  pool->start();
  world.wait_for_state(id, JobState::Succeeded);
  EXPECT_EQ(*world.store->result_document(id), expected());
  EXPECT_EQ(threads.size(), 2U);
}

TEST(JobParts, AShortJobIsNotDivided) {
  DividedWorld world(slow_square);
  const std::string id = world.add_toy();
  WorkerOptions options = eager(3);
  options.worth_sharing_seconds = 11.0;
  std::atomic<bool> divided{false};
  const auto pool = world.divided_pool(options);
  pool->start();
  world.wait_for(id, [&](const Job& job) {
    divided = divided || world.store->parts().count_finished_parts(id).value() > 0;
    return job.state == JobState::Succeeded;
  });
  EXPECT_FALSE(divided);
  EXPECT_EQ(*world.store->result_document(id), expected());
}

TEST(JobParts, EnoughIsEnoughWhereverTheRestIs) {
  for (const int threads : {1, 4}) {
    DividedWorld world(slow_square, 5);
    const std::string id = world.add_toy();
    const auto pool = world.divided_pool(eager(threads));
    pool->start();
    world.wait_for_state(id, JobState::Succeeded);
    EXPECT_EQ(*world.store->result_document(id), expected(5));
  }
}

TEST(JobParts, OfSeveralPartsThatFailTheFirstIsTold) {
  for (const int threads : {1, 4}) {
    DividedWorld world([](std::size_t number, const RunControl&) -> Result<std::string> {
      if (number == 3) {
        std::this_thread::sleep_for(std::chrono::milliseconds(30));  // the other one fails before
        return fail(ErrorCode::TooFewSamples, "The third has too few samples.");
      }
      if (number == 5) {
        return fail(ErrorCode::NonFinite, "The fifth is not finite.");
      }
      return square(number);
    });
    const std::string id = world.add_toy();
    const auto pool = world.divided_pool(eager(threads));
    pool->start();
    const Job job = world.wait_for_state(id, JobState::Failed);
    EXPECT_THAT(job.problem_json, HasSubstr("The third has too few samples."));
    EXPECT_EQ(job.attempt_problems_json.size(), 1U);
  }
}

TEST(JobParts, WhatAHelperCouldNotReadIsComputedByTheJobsOwnWorker) {
  std::atomic<int> failures{0};
  DividedWorld world([&](std::size_t number, const RunControl&) -> Result<std::string> {
    if (number == 0 && failures++ == 0) {
      return fail(ErrorCode::Io, "The disk of that host did not answer.");
    }
    return square(number);
  });
  const std::string id = world.add_toy();
  const auto pool = world.divided_pool(eager(1));
  pool->start();
  EXPECT_EQ(world.wait_for_state(id, JobState::Succeeded).failures, 0);
  EXPECT_EQ(*world.store->result_document(id), expected());
}

TEST(JobParts, AnotherAttemptGoesOnWhereTheFirstWasLost) {
  std::atomic<int> computed{0};
  Gate seven;
  std::atomic<bool> holds{true};
  DividedWorld world([&](std::size_t number, const RunControl& control) -> Result<std::string> {
    if (number == 7 && holds) {
      seven.open();
      Gate never;
      never.pass(control.stop);
      return fail(ErrorCode::Cancelled, "stopped");
    }
    ++computed;
    return square(number);
  });
  const std::string id = world.add_toy();
  {
    const auto first = world.divided_pool(eager(1));
    first->start();
    seven.pass();
    first->stop();  // hands the job back, with its part
  }
  EXPECT_EQ(computed, 7);
  holds = false;
  const auto second = world.divided_pool(eager(1));
  second->start();
  EXPECT_EQ(world.wait_for_state(id, JobState::Succeeded).attempt, 2);
  EXPECT_EQ(computed, static_cast<int>(kParts)) << "no part twice";
  EXPECT_EQ(*world.store->result_document(id), expected());
}

TEST(JobParts, APartOfAHelperThatDiedIsTakenBackWhenItsLeaseRunsOut) {
  Gate taken;
  DividedWorld world([&](std::size_t number, const RunControl& control) -> Result<std::string> {
    taken.pass(control.stop);  // until the helper that dies has its part
    return square(number);
  });
  const std::string id = world.add_toy();
  const auto pool = world.divided_pool(eager(1));
  pool->start();
  std::optional<PartClaim> lost;
  for (int i = 0; i < 20'000 && !lost; ++i) {  // nobody is told of the moment in which the job is divided
    lost = world.store->parts().claim_part(id, false, 60'000'000).value();
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  ASSERT_TRUE(lost);
  taken.open();
  while (world.store->parts().count_finished_parts(id).value() < std::int64_t{kParts} - 1) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_EQ(world.store->job(id)->state, JobState::Running) << "one part is missing";
  world.clock.advance(60'000'001);
  world.wait_for_state(id, JobState::Succeeded);
  EXPECT_EQ(*world.store->result_document(id), expected());
}

TEST(JobParts, ACancelledJobStopsItsHelpersToo) {
  std::atomic<int> inside{0};
  DividedWorld world([&](std::size_t, const RunControl& control) -> Result<std::string> {
    ++inside;
    Gate never;
    never.pass(control.stop);
    --inside;
    return fail(ErrorCode::Cancelled, "stopped");
  });
  const std::string id = world.add_toy();
  WorkerOptions options = eager(3);
  options.renew_micros = 5000;
  const auto pool = world.divided_pool(options);
  pool->start();
  while (inside < 3) {
    std::this_thread::yield();
  }
  ASSERT_TRUE(world.store->request_cancel(id));
  world.wait_for_state(id, JobState::Cancelled);
  for (int i = 0; inside > 0 && i < 10'000; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_EQ(inside, 0);
}

TEST(JobParts, AnExceptionInAHelperLeavesThePartToTheJobsOwnWorker) {
  std::atomic<int> thrown{0};
  DividedWorld world([&](std::size_t number, const RunControl& control) -> Result<std::string> {
    const bool helps = !control.progress;  // the job's own worker tells of its progress
    if (helps && thrown++ == 0) {
      throw std::runtime_error("on that host alone");
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
    return square(number);
  });
  const std::string id = world.add_toy();
  const auto pool = world.divided_pool(eager(2));
  pool->start();
  for (int i = 0; i < 10'000 && !is_terminal(world.store->job(id)->state); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    if (thrown > 0 && world.store->parts().count_finished_parts(id).value() == std::int64_t{kParts} - 1) {
      world.clock.advance(60'000'001);  // the lease of the part runs out
    }
  }
  ASSERT_EQ(world.store->job(id)->state, JobState::Succeeded);
  EXPECT_EQ(*world.store->result_document(id), expected());
}

}  // namespace
}  // namespace driftlab::server
