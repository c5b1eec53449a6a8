#pragma once
/// Connections to an SQLite file: the engine of the store that needs nothing else.
#include "core/signal/result.hpp"
#include "server/store/sql/connection.hpp"

#include <sqlite3.h>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>

namespace driftlab::server {

enum class Access { ReadWrite, ReadOnly };

class SqliteConnection final : public Connection {
 public:
  /// Opens with every setting of the store: no extension loading, defensive mode, untrusted schema, no memory map,
  /// foreign keys, busy timeout of 5 s; the writer also WAL and synchronous=FULL. Errors: Io, DiskFull.
  [[nodiscard]] static Result<std::unique_ptr<SqliteConnection>> open(const std::filesystem::path& path, Access access);
  SqliteConnection(const SqliteConnection&) = delete;
  SqliteConnection& operator=(const SqliteConnection&) = delete;
  ~SqliteConnection() override;

  /// Runs one or more statements without values, for migrations, pragmas and transactions.
  [[nodiscard]] Status execute(const std::string& sql);
  [[nodiscard]] int changes() override { return sqlite3_changes(handle_); }
  [[nodiscard]] Engine engine() const override { return Engine::Sqlite; }
  /// Rows changed since the connection was opened, those of foreign keys' actions included.
  [[nodiscard]] std::int64_t total_changes() const { return sqlite3_total_changes64(handle_); }
  /// True between BEGIN and its end; SQLite ends a transaction by itself after a full disk.
  [[nodiscard]] bool in_transaction() const { return sqlite3_get_autocommit(handle_) == 0; }
  /// Closing it copies nothing more from the write-ahead log into the database.
  void leave_log_on_close() { (void)sqlite3_db_config(handle_, SQLITE_DBCONFIG_NO_CKPT_ON_CLOSE, 1, nullptr); }
  /// What `status` means: code and sentence.
  [[nodiscard]] Error error(int status) const;

 private:
  SqliteConnection(sqlite3* handle, std::filesystem::path path) : handle_(handle), path_(std::move(path)) {}
  [[nodiscard]] Status configure(Access access);
  [[nodiscard]] std::unique_ptr<EngineStatement> make_statement(std::string_view sql) override;

  sqlite3* handle_;
  std::filesystem::path path_;
  std::unordered_map<std::string, sqlite3_stmt*> statements_;
};

}  // namespace driftlab::server
