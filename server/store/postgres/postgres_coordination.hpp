#pragma once
/// Coordination by PostgreSQL: duties, keys and workers are advisory locks of one connection, hints are notifications
/// (LISTEN, NOTIFY) that a second one hears.
///
/// Both connections must reach the server directly: a pooler that hands connections on by the transaction drops locks
/// and notifications without a word. What triggers of the database notify of: migrations/postgres/0011.
#include "server/store/coordination.hpp"
#include "server/store/postgres/connection_pool.hpp"
#include "server/store/postgres/daemon_lock.hpp"

#include <array>
#include <chrono>
#include <memory>
#include <mutex>
#include <set>
#include <stop_token>
#include <string>
#include <thread>

namespace driftlab::server {

class PostgresCoordination final : public Coordination {
 public:
  /// `origin` marks what this process does among the notifications; its connections have it as `driftlab.origin`.
  /// `lock` must outlive this object.
  PostgresCoordination(ConnectionPool::Opener open, DaemonLock& lock, std::string origin)
      : open_(std::move(open)), lock_(lock), origin_(std::move(origin)) {}
  PostgresCoordination(const PostgresCoordination&) = delete;
  PostgresCoordination& operator=(const PostgresCoordination&) = delete;
  ~PostgresCoordination() override { PostgresCoordination::stop(); }

  [[nodiscard]] bool came_first() const override { return lock_.came_first(); }
  [[nodiscard]] Status admit_others() override { return lock_.admit_others(); }
  [[nodiscard]] bool has_duty(Duty duty) override;
  [[nodiscard]] Result<bool> take_key(std::string_view key) override;
  void give_back_key(std::string_view key) override;
  void offer_workers(int count) override;
  [[nodiscard]] Result<int> workers() override;
  void tell(std::string_view words) override;
  void listen(Hints hints) override;
  void stop() override;

 private:
  /// The connection of the locks, there or made anew; keys and workers are held again then. Errors: Io.
  [[nodiscard]] Status connect();
  void hear(const std::stop_token& stop, const Hints& hints);
  void pass_on(const Hints& hints, const std::string& payload) const;

  const ConnectionPool::Opener open_;
  DaemonLock& lock_;
  const std::string origin_;
  std::mutex mutex_;
  std::unique_ptr<PostgresConnection> connection_;
  std::chrono::steady_clock::time_point not_before_{};
  std::array<bool, 3> duties_{};
  std::set<std::string, std::less<>> keys_;
  int workers_ = 0;
  std::jthread hearing_;
};

}  // namespace driftlab::server
