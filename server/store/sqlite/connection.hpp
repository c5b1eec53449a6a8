#pragma once
/// SQLite connections and statements that clean up after themselves and report through `Result`.
///
/// A connection belongs to one thread at a time. SQL texts are constants; values are only ever bound. Each text is
/// prepared once per connection and kept.
#include "core/signal/result.hpp"

#include <sqlite3.h>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>

namespace driftlab::server {

class Connection;

/// A prepared statement on loan from its connection; goes back (reset, bindings cleared) when this object dies.
/// Values are bound in the order of the question marks. A failed bind is reported by the next step.
class Statement {
 public:
  Statement(Connection& connection, sqlite3_stmt* statement, int status);
  Statement(const Statement&) = delete;
  Statement& operator=(const Statement&) = delete;
  ~Statement();

  Statement& bind(std::int64_t value);
  Statement& bind(int value) { return bind(std::int64_t{value}); }
  Statement& bind(double value);
  Statement& bind(std::string_view value);
  Statement& bind(const std::string& value) { return bind(std::string_view(value)); }
  Statement& bind(const char* value) { return bind(std::string_view(value)); }
  template <class T>
  Statement& bind(const std::optional<T>& value) {
    return value ? bind(*value) : bind_null();
  }
  template <class First, class Second, class... Rest>
  Statement& bind(const First& first, const Second& second, const Rest&... rest) {
    bind(first);
    return bind(second, rest...);
  }
  Statement& bind_null();

  /// Advances to the next row: true if there is one. Errors: DiskFull, Io, Internal (a constraint).
  [[nodiscard]] Result<bool> step();
  /// Runs to the end, ignoring rows.
  [[nodiscard]] Status run();

  // Columns of the present row, from 0.
  [[nodiscard]] std::int64_t integer(int column) const { return sqlite3_column_int64(statement_, column); }
  [[nodiscard]] double real(int column) const { return sqlite3_column_double(statement_, column); }
  [[nodiscard]] std::string text(int column) const;
  [[nodiscard]] std::optional<std::int64_t> optional_integer(int column) const;

 private:
  Connection& connection_;
  sqlite3_stmt* statement_;
  int status_;
  int bound_ = 0;
};

enum class Access { ReadWrite, ReadOnly };

class Connection {
 public:
  /// Opens with every setting of the store: no extension loading, defensive mode, untrusted schema, no memory map,
  /// foreign keys, busy timeout of 5 s; the writer also WAL and synchronous=FULL. Errors: Io, DiskFull.
  [[nodiscard]] static Result<std::unique_ptr<Connection>> open(const std::filesystem::path& path, Access access);
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;
  ~Connection();

  [[nodiscard]] Statement prepare(std::string_view sql);
  /// Runs one or more statements without values, for migrations, pragmas and transactions.
  [[nodiscard]] Status execute(const std::string& sql);
  /// The first column of the first row of a query; nothing without rows.
  [[nodiscard]] Result<std::optional<std::int64_t>> query_integer(std::string_view sql);
  [[nodiscard]] Result<std::optional<std::string>> query_text(std::string_view sql);
  /// Rows changed by the latest INSERT, UPDATE or DELETE.
  [[nodiscard]] int changes() const { return sqlite3_changes(handle_); }
  /// True between BEGIN and its end; SQLite ends a transaction by itself after a full disk.
  [[nodiscard]] bool in_transaction() const { return sqlite3_get_autocommit(handle_) == 0; }
  /// What `status` means: code and sentence.
  [[nodiscard]] Error error(int status) const;

 private:
  Connection(sqlite3* handle, std::filesystem::path path) : handle_(handle), path_(std::move(path)) {}
  [[nodiscard]] Status configure(Access access);

  sqlite3* handle_;
  std::filesystem::path path_;
  std::unordered_map<std::string, sqlite3_stmt*> statements_;
};

}  // namespace driftlab::server
