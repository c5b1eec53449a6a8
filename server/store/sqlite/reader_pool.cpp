#include "server/store/sqlite/reader_pool.hpp"

namespace driftlab::server {

Result<std::unique_ptr<ReaderPool>> ReaderPool::open(const std::filesystem::path& path, int readers) {
  auto pool = std::make_unique<ReaderPool>();
  for (int i = 0; i < readers; ++i) {
    Result<std::unique_ptr<SqliteConnection>> connection = SqliteConnection::open(path, Access::ReadOnly);
    if (!connection) {
      return fail(connection.error());
    }
    pool->idle_.push_back(std::move(*connection));
  }
  return pool;
}

std::unique_ptr<SqliteConnection> ReaderPool::take() {
  std::unique_lock<std::mutex> guard(mutex_);
  returned_.wait(guard, [this] { return !idle_.empty(); });
  std::unique_ptr<SqliteConnection> connection = std::move(idle_.back());
  idle_.pop_back();
  return connection;
}

void ReaderPool::give_back(std::unique_ptr<SqliteConnection> connection) {
  {
    const std::lock_guard<std::mutex> guard(mutex_);
    idle_.push_back(std::move(connection));
  }
  returned_.notify_one();
}

}  // namespace driftlab::server
