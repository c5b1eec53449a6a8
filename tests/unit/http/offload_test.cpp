#include "server/http/offload.hpp"

#include <boost/asio/detached.hpp>
#include <boost/asio/io_context.hpp>
#include <gtest/gtest.h>

#include <future>
#include <latch>
#include <thread>
#include <vector>

namespace driftlab::server {
namespace {

namespace asio = boost::asio;

TEST(BoundedPool, RunsWorkOffTheIoThreadAndComesBackToIt) {
  asio::io_context io;
  BoundedPool pool(1, 0);
  std::thread::id worked;
  std::thread::id resumed;
  const auto caller = [&]() -> asio::awaitable<void> {
    auto work = [] { return std::this_thread::get_id(); };
    const auto outcome = co_await pool.run(work);
    worked = outcome.value_or(std::thread::id());
    resumed = std::this_thread::get_id();
  };
  asio::co_spawn(io, caller(), asio::detached);
  io.run();
  pool.join();
  EXPECT_NE(worked, std::thread::id());
  EXPECT_NE(worked, std::this_thread::get_id());
  EXPECT_EQ(resumed, std::this_thread::get_id());
}

TEST(BoundedPool, RefusesWorkWhenItsQueueIsFull) {
  asio::io_context io;
  BoundedPool pool(1, 2);  // one runs, two wait
  std::latch release(1);
  std::vector<int> finished;
  int refused = 0;
  const auto caller = [&](int number) -> asio::awaitable<void> {
    auto work = [&release, number] {
      release.wait();
      return number;
    };
    const auto outcome = co_await pool.run(work);
    if (outcome) {
      finished.push_back(*outcome);
    } else if (++refused == 2) {
      release.count_down();  // the pool is full for as long as anybody is still to be refused
    }
  };
  for (int number = 0; number < 5; ++number) {
    asio::co_spawn(io, caller(number), asio::detached);
  }
  io.run();
  EXPECT_EQ(refused, 2);
  EXPECT_EQ(finished, (std::vector<int>{0, 1, 2}));
  // What was refused or has run takes no place.
  asio::co_spawn(io, caller(7), asio::detached);
  io.restart();
  io.run();
  pool.join();
  EXPECT_EQ(finished.back(), 7);
}

}  // namespace
}  // namespace driftlab::server
