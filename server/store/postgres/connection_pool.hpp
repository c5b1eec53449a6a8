#pragma once
/// A few connections to one database that threads borrow, opened when they are first needed.
///
/// Where one turns out to be broken all idle ones are closed, for they broke with it. Where the database does not
/// answer it is asked again after pauses of 0.1 s to 5 s, each drawn between its half and its whole, so that daemons
/// that lost it together do not come back together; a request during a pause fails at once with the error of the last
/// attempt.
#include "core/signal/result.hpp"
#include "server/store/postgres/connection.hpp"

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <random>
#include <vector>

namespace driftlab::server {

class ConnectionPool {
 public:
  using Opener = std::function<Result<std::unique_ptr<PostgresConnection>>()>;

  /// At most `size` connections at a time, one at least.
  ConnectionPool(Opener open, int size, std::uint64_t jitter_seed);
  ConnectionPool(const ConnectionPool&) = delete;
  ConnectionPool& operator=(const ConnectionPool&) = delete;
  ~ConnectionPool() = default;

  /// A connection until it dies. It must not outlive the pool.
  class Loan {
   public:
    Loan(ConnectionPool& pool, std::unique_ptr<PostgresConnection> connection, std::uint64_t generation)
        : pool_(&pool), connection_(std::move(connection)), generation_(generation) {}
    Loan(const Loan&) = delete;
    Loan& operator=(const Loan&) = delete;
    Loan(Loan&& other) noexcept = default;
    Loan& operator=(Loan&& other) = delete;
    ~Loan() {
      if (connection_) {
        pool_->give_back(std::move(connection_), generation_);
      }
    }
    [[nodiscard]] PostgresConnection* operator->() const { return connection_.get(); }
    [[nodiscard]] PostgresConnection& operator*() const { return *connection_; }

   private:
    ConnectionPool* pool_;
    std::unique_ptr<PostgresConnection> connection_;
    std::uint64_t generation_;
  };

  /// Waits up to 10 s for a connection that others use. Errors: Io.
  [[nodiscard]] Result<Loan> take();

  /// Closes every connection: idle ones now, those that are lent out when they are given back.
  void retire();

 private:
  using Moment = std::chrono::steady_clock::time_point;

  void give_back(std::unique_ptr<PostgresConnection> connection, std::uint64_t generation);
  [[nodiscard]] Result<Loan> open_another(std::uint64_t generation);
  void note_failure(const Error& error);

  const Opener open_;
  const int size_;
  std::mutex mutex_;
  std::condition_variable returned_;
  std::vector<std::unique_ptr<PostgresConnection>> idle_;
  std::uint64_t generation_ = 0;  ///< of the connections that were not retired
  int opened_ = 0;                ///< idle, lent out and being opened
  std::mt19937_64 jitter_;
  std::chrono::milliseconds pause_{};
  Moment not_before_{};
  std::optional<Error> last_failure_;
};

}  // namespace driftlab::server
