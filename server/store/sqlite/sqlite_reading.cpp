#include "server/store/sqlite/sqlite_reading.hpp"

#include "server/store/sqlite/reader_pool.hpp"

#include <utility>

namespace driftlab::server {
namespace {

class SqliteReading final : public Database {
 public:
  explicit SqliteReading(std::unique_ptr<ReaderPool> readers) : readers_(std::move(readers)) {}

  [[nodiscard]] UtcMicros now(const Connection& /*connection*/) const override { return clock_.now(); }
  [[nodiscard]] std::uint64_t changes() const override { return 0; }

 private:
  [[nodiscard]] Status run_write(WriteKind /*kind*/, const std::function<Status(Connection&)>& /*work*/) override {
    return fail(ErrorCode::Conflict, "The store was opened for reading alone.");
  }
  [[nodiscard]] Status run_read(const std::function<Status(Connection&)>& work) override {
    return readers_->read([&](SqliteConnection& c) { return work(c); });
  }

  SystemClock clock_;
  std::unique_ptr<ReaderPool> readers_;
};

}  // namespace

Result<std::unique_ptr<Database>> open_sqlite_reading(const std::filesystem::path& file) {
  auto readers = ReaderPool::open(file, 1);
  if (!readers) {
    return fail(readers.error());
  }
  return std::make_unique<SqliteReading>(std::move(*readers));
}

}  // namespace driftlab::server
