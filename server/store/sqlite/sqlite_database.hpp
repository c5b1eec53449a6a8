#pragma once
/// The transactions of an SQLite file: one thread writes, a few connections read.
#include "server/store/files.hpp"
#include "server/store/sql/database.hpp"
#include "server/store/sqlite/migrations.hpp"
#include "server/store/sqlite/reader_pool.hpp"
#include "server/store/sqlite/writer.hpp"

#include <filesystem>
#include <memory>

namespace driftlab::server {

/// Writes come one after the other, so that each kind of them is served alike. The time is that of the clock at hand.
class SqliteDatabase final : public Database {
 public:
  SqliteDatabase(FileHandle lock, const Clock& clock, std::filesystem::path file,
                 std::unique_ptr<SqliteConnection> writer, std::unique_ptr<CommitLog> commits,
                 std::unique_ptr<ReaderPool> readers)
      : lock_(std::move(lock)),
        clock_(clock),
        file_(std::move(file)),
        writer_(std::move(writer), std::move(commits)),
        readers_(std::move(readers)) {}

  [[nodiscard]] UtcMicros now(const Connection& /*connection*/) const override { return clock_.now(); }
  [[nodiscard]] std::uint64_t changes() const override { return writer_.changes(); }
  [[nodiscard]] std::optional<std::int64_t> log_pages() const override {
    constexpr std::int64_t kFrameBytes = 4096 + 24;  // https://sqlite.org/fileformat2.html#walformat
    std::error_code absent;
    const std::uintmax_t bytes = std::filesystem::file_size(file_.string() + "-wal", absent);
    return absent ? 0 : static_cast<std::int64_t>(bytes) / kFrameBytes;
  }
  [[nodiscard]] Status copy_to(const std::filesystem::path& target) {
    return readers_->borrow([&](SqliteConnection& c) { return copy_database(c, target); });
  }

 private:
  [[nodiscard]] Status run_write(WriteKind /*kind*/, const std::function<Status(Connection&)>& work) override {
    return writer_.write([&](SqliteConnection& c) { return work(c); });
  }
  [[nodiscard]] Status run_read(const std::function<Status(Connection&)>& work) override {
    return readers_->read([&](SqliteConnection& c) { return work(c); });
  }

  // Destroyed from below: readers first, so that the writer's connection is the last and empties the log; then the
  // lock.
  FileHandle lock_;
  const Clock& clock_;
  const std::filesystem::path file_;
  Writer writer_;
  std::unique_ptr<ReaderPool> readers_;
};

}  // namespace driftlab::server
