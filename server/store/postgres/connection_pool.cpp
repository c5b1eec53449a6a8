#include "server/store/postgres/connection_pool.hpp"

#include "server/store/silent_store.hpp"

#include <algorithm>
#include <string>

namespace driftlab::server {
namespace {

constexpr std::chrono::seconds kPatience{10};
constexpr std::chrono::milliseconds kFirstPause{100};
constexpr std::chrono::milliseconds kLongestPause{5000};

}  // namespace

ConnectionPool::ConnectionPool(Opener open, int size, std::uint64_t jitter_seed)
    : open_(std::move(open)), size_(std::max(size, 1)), jitter_(jitter_seed) {}

Result<ConnectionPool::Loan> ConnectionPool::take() {
  std::unique_lock<std::mutex> guard(mutex_);
  const bool served = returned_.wait_for(guard, kPatience, [this] { return !idle_.empty() || opened_ < size_; });
  if (!served) {
    return fail(silent_store("Every connection to the database is in use (" + std::to_string(size_) + ")."));
  }
  if (!idle_.empty()) {
    std::unique_ptr<PostgresConnection> connection = std::move(idle_.back());
    idle_.pop_back();
    return Loan(*this, std::move(connection), generation_);
  }
  if (last_failure_ && std::chrono::steady_clock::now() < not_before_) {
    return fail(*last_failure_);
  }
  ++opened_;
  const std::uint64_t generation = generation_;
  guard.unlock();
  return open_another(generation);
}

Result<ConnectionPool::Loan> ConnectionPool::open_another(std::uint64_t generation) {
  auto connection = open_();
  const std::lock_guard<std::mutex> guard(mutex_);
  if (connection) {
    pause_ = {};
    last_failure_.reset();
    return Loan(*this, std::move(*connection), generation);
  }
  --opened_;
  note_failure(connection.error());
  returned_.notify_one();
  return fail(connection.error());
}

void ConnectionPool::note_failure(const Error& error) {
  pause_ = std::clamp(pause_ * 2, kFirstPause, kLongestPause);
  const std::chrono::milliseconds drawn(
      std::uniform_int_distribution<std::int64_t>(pause_.count() / 2, pause_.count())(jitter_));
  not_before_ = std::chrono::steady_clock::now() + drawn;
  last_failure_ = error;
}

void ConnectionPool::retire() {
  std::vector<std::unique_ptr<PostgresConnection>> retired;  // closed without the lock
  {
    const std::lock_guard<std::mutex> guard(mutex_);
    ++generation_;
    retired.swap(idle_);
    opened_ -= static_cast<int>(retired.size());
  }
  returned_.notify_all();
}

void ConnectionPool::give_back(std::unique_ptr<PostgresConnection> connection, std::uint64_t generation) {
  std::vector<std::unique_ptr<PostgresConnection>> broken;  // closed without the lock
  {
    const std::lock_guard<std::mutex> guard(mutex_);
    if (connection->is_broken()) {
      broken.swap(idle_);
      broken.push_back(std::move(connection));
      opened_ -= static_cast<int>(broken.size());
    } else if (generation != generation_) {
      broken.push_back(std::move(connection));
      --opened_;
    } else {
      idle_.push_back(std::move(connection));
    }
  }
  broken.empty() ? returned_.notify_one() : returned_.notify_all();
}

}  // namespace driftlab::server
