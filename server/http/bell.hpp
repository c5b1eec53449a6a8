#pragma once
/// Wakes the connections that wait for a subject, a job by its id or the log of events: SSE streams and `Prefer:
/// wait=`. A ring is a hint; waiters look at the store and have a deadline of their own, so a lost ring costs time and
/// never correctness.
#include <boost/asio/awaitable.hpp>
#include <boost/asio/steady_timer.hpp>

#include <chrono>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace driftlab::server {

class Bell {
 public:
  /// One waiting connection. Lives on the executor of its timer.
  class Listener : public std::enable_shared_from_this<Listener> {
   public:
    explicit Listener(const boost::asio::any_io_executor& executor) : timer_(executor) {}
    /// Returns when rung since the last call, or after `longest`.
    boost::asio::awaitable<void> wait(std::chrono::steady_clock::duration longest);
    /// Thread safe.
    void notify();

   private:
    boost::asio::steady_timer timer_;
    bool rung_ = false;
  };

  [[nodiscard]] std::shared_ptr<Listener> listen(const std::string& subject,
                                                 const boost::asio::any_io_executor& executor);
  /// Something happened to it. Thread safe.
  void ring(const std::string& subject);
  /// Wakes everybody, for the stop of the daemon. Thread safe.
  void ring_all();

 private:
  std::mutex mutex_;
  std::multimap<std::string, std::weak_ptr<Listener>> listeners_;
};

}  // namespace driftlab::server
