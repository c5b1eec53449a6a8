#include "core/signal/executor.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <latch>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace driftlab {
namespace {

/// Counts the threads that are inside at once.
class Census {
 public:
  void enter() {
    const int now = ++inside_;
    int most = most_;
    while (now > most && !most_.compare_exchange_weak(most, now)) {
    }
  }
  void leave() { --inside_; }
  [[nodiscard]] int most() const { return most_; }

 private:
  std::atomic<int> inside_{0};
  std::atomic<int> most_{0};
};

/// Some work whose result depends on the order of its own sums only.
double worked_out(std::size_t number) {
  double sum = 0.0;
  for (int i = 1; i < 2000; ++i) {
    sum += std::sin(static_cast<double>(number) + 1.0 / i);
  }
  return sum;
}

TEST(Executor, DoesEveryTaskOnceAndGivesTheSameBitsForAnyNumberOfThreads) {
  constexpr std::size_t kTasks = 200;
  std::vector<double> expected(kTasks);
  parallel_for({}, kTasks, [&](std::size_t i) { expected[i] = worked_out(i); });
  for (const unsigned threads : {1U, 2U, 8U}) {
    Executor executor(threads);
    std::vector<double> found(kTasks);
    std::vector<std::atomic<int>> calls(kTasks);
    parallel_for({&executor}, kTasks, [&](std::size_t i) {
      found[i] = worked_out(i);
      ++calls[i];
    });
    EXPECT_EQ(found, expected) << threads << " threads";
    EXPECT_TRUE(std::all_of(calls.begin(), calls.end(), [](const auto& count) { return count == 1; }));
  }
}

TEST(Executor, UsesEveryThreadThatItHas) {
  Executor executor(4);
  ASSERT_EQ(executor.threads(), 4U);
  std::latch all(4);
  parallel_for({&executor}, 4, [&](std::size_t) { all.arrive_and_wait(); });  // ends only where four run at once
}

TEST(Executor, NeverRunsMoreTasksAtOnceThanItHasThreadsHoweverManyComputationsShareIt) {
  constexpr int kThreads = 3;
  Executor executor(kThreads);
  Census census;
  std::atomic<int> done{0};
  const auto compute = [&] {
    for (int round = 0; round < 20; ++round) {
      parallel_for({&executor}, 10, [&](std::size_t i) {
        census.enter();
        EXPECT_TRUE(std::isfinite(worked_out(i)));
        census.leave();
        ++done;
      });
    }
  };
  {
    std::vector<std::jthread> callers;
    for (int i = 0; i < 8; ++i) {
      callers.emplace_back(compute);
    }
  }
  EXPECT_EQ(done, 8 * 20 * 10);
  EXPECT_LE(census.most(), kThreads);
  std::latch all(kThreads);  // no seat was lost
  parallel_for({&executor}, kThreads, [&](std::size_t) { all.arrive_and_wait(); });
}

TEST(Executor, AWorkerThatHoldsASeatCountsAmongThoseThatCompute) {
  Executor executor(2);
  const Executor::Seat mine(executor);
  Census census;
  std::jthread other([&] {
    const Executor::Seat seat(executor);
    parallel_for({&executor}, 50, [&](std::size_t i) {
      census.enter();
      EXPECT_TRUE(std::isfinite(worked_out(i)));
      census.leave();
    });
  });
  other.join();
  EXPECT_EQ(census.most(), 1) << "one seat of two was taken, so nobody could help";
}

TEST(Executor, AHelperGivesItsSeatToACallerThatWantsToBegin) {
  Executor executor(2);
  std::latch both(2);
  std::atomic<bool> began{false};
  std::atomic<int> after{0};
  std::jthread newcomer([&] {
    both.wait();
    const Executor::Seat seat(executor);  // both seats are taken by one computation, which has far more to do
    began = true;
  });
  parallel_for({&executor}, 100000, [&](std::size_t i) {
    if (i < 2) {
      both.arrive_and_wait();
    }
    if (!began) {
      std::this_thread::yield();
      EXPECT_TRUE(std::isfinite(worked_out(i)));
    } else {
      ++after;
    }
  });
  newcomer.join();
  EXPECT_GT(after, 0) << "the newcomer waited for the end of the whole computation";
}

TEST(Executor, AnExceptionOfATaskReachesTheCallerAndOthersGoOn) {
  // An exception in a thread that helped an outage evaluation ended the daemon, and with it every other job.
  Executor executor(3);
  std::atomic<int> others{0};
  std::jthread other([&] { parallel_for({&executor}, 300, [&](std::size_t) { ++others; }); });
  const auto caller = std::this_thread::get_id();
  std::latch both(2);
  try {
    parallel_for({&executor}, 2, [&](std::size_t i) {
      both.arrive_and_wait();
      if (std::this_thread::get_id() != caller) {
        throw std::runtime_error("task " + std::to_string(i));
      }
    });
    FAIL() << "the exception was lost";
  } catch (const std::runtime_error& error) {
    EXPECT_EQ(std::string(error.what()).substr(0, 5), "task ");
  }
  other.join();
  EXPECT_EQ(others, 300);
  std::latch all(3);  // no seat was lost
  parallel_for({&executor}, 3, [&](std::size_t) { all.arrive_and_wait(); });
}

TEST(Executor, OfSeveralExceptionsThatOfTheLowestTaskIsThrown) {
  for (const unsigned threads : {1U, 2U, 8U}) {
    Executor executor(threads);
    for (int round = 0; round < 50; ++round) {
      std::string said;
      try {
        parallel_for({&executor}, 100, [](std::size_t i) {
          if (i >= 7) {
            throw std::runtime_error(std::to_string(i));
          }
        });
      } catch (const std::runtime_error& error) {
        said = error.what();
      }
      ASSERT_EQ(said, "7") << threads << " threads";
    }
  }
  Executor two(2);
  for (int round = 0; round < 50; ++round) {
    std::latch both(2);
    std::string said;
    try {
      parallel_for({&two}, 2, [&](std::size_t i) {
        both.arrive_and_wait();
        throw std::runtime_error(std::to_string(i));
      });
    } catch (const std::runtime_error& error) {
      said = error.what();
    }
    ASSERT_EQ(said, "0");
  }
}

TEST(Executor, TasksMayHandOutTasksWhileEveryThreadDoes) {
  Executor executor(3);
  std::atomic<int> done{0};
  const auto nested = [&] {
    parallel_for({&executor}, 6, [&](std::size_t) {
      parallel_for({&executor}, 5, [&](std::size_t) { parallel_for({&executor}, 4, [&](std::size_t) { ++done; }); });
    });
  };
  {
    std::vector<std::jthread> callers;
    for (int i = 0; i < 5; ++i) {
      callers.emplace_back(nested);
    }
  }
  EXPECT_EQ(done, 5 * 6 * 5 * 4);
}

TEST(Executor, BeginsNoTaskAfterStopIsRequested) {
  Executor eight(8);
  for (const ThreadShare& share : {ThreadShare{}, ThreadShare{&eight}}) {
    std::stop_source source;
    std::atomic<int> begun{0};
    std::atomic<int> begun_late{0};
    parallel_for(
        share, 10000,
        [&](std::size_t) {
          begun_late += source.stop_requested() ? 1 : 0;
          if (++begun == 10) {
            source.request_stop();
          }
        },
        source.get_token());
    EXPECT_GE(begun, 10);
    EXPECT_LE(begun_late, 8) << "at most the tasks that were just being taken";
  }
}

TEST(Executor, WrapsWhatHelpersDoAndNothingElse) {
  Executor executor(2);
  static thread_local const char* at_work = "nobody";
  const auto around_with = [](const char* name) {
    return [name](const std::function<void()>& work) {
      at_work = name;
      work();
      at_work = "nobody";
    };
  };
  at_work = "caller";
  const auto caller = std::this_thread::get_id();
  for (const char* const name : {"first", "second"}) {
    const ThreadShare share{&executor, around_with(name)};
    std::array<std::string, 2> seen;
    std::latch both(2);
    parallel_for(share, 2, [&](std::size_t) {
      both.arrive_and_wait();
      seen[std::this_thread::get_id() == caller ? 0 : 1] = at_work;
    });
    EXPECT_EQ(seen[0], "caller");
    EXPECT_EQ(seen[1], name);
  }
}

TEST(Executor, AnExceptionOfTheWrappingReachesTheCallerToo) {
  Executor executor(2);
  std::latch thrown(1);
  const ThreadShare share{&executor, [&](const std::function<void()>&) {
                            thrown.count_down();
                            throw std::runtime_error("around");
                          }};
  EXPECT_THROW(parallel_for(share, 2, [&](std::size_t) { thrown.wait(); }), std::runtime_error);
}

}  // namespace
}  // namespace driftlab
