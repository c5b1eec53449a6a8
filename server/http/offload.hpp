#pragma once
/// Work off the I/O threads: a pool with a bounded queue, awaited from a coroutine.
#include <boost/asio/awaitable.hpp>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/thread_pool.hpp>
#include <boost/asio/use_awaitable.hpp>

#include <atomic>
#include <optional>
#include <utility>

namespace driftlab::server {

class BoundedPool {
 public:
  BoundedPool(std::size_t threads, std::size_t longest_queue) : pool_(threads), longest_(threads + longest_queue) {}

  /// Runs `work` on the pool and resumes the caller on its own executor. Nothing if the queue is full: the caller
  /// answers 503.
  template <class Work>
  boost::asio::awaitable<std::optional<std::invoke_result_t<Work>>> run(Work work) {
    using Value = std::invoke_result_t<Work>;
    if (waiting_.fetch_add(1) >= longest_) {
      waiting_.fetch_sub(1);
      co_return std::nullopt;
    }
    auto task = [this, work = std::move(work)]() mutable -> boost::asio::awaitable<Value> {
      struct Leave {
        std::atomic<std::size_t>& waiting;
        explicit Leave(std::atomic<std::size_t>& counter) : waiting(counter) {}
        Leave(const Leave&) = delete;
        Leave& operator=(const Leave&) = delete;
        ~Leave() { waiting.fetch_sub(1); }
      } const leave(waiting_);
      co_return work();
    };
    co_return co_await boost::asio::co_spawn(pool_.get_executor(), std::move(task), boost::asio::use_awaitable);
  }

  void join() { pool_.join(); }

 private:
  boost::asio::thread_pool pool_;
  std::atomic<std::size_t> waiting_{0};
  std::size_t longest_;
};

}  // namespace driftlab::server
