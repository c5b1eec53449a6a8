#pragma once
/// What the tables of the store ask of a database engine: statements with bound values, read row by row.
///
/// The files of this folder are written once for every engine. Their texts keep to what SQLite and PostgreSQL both
/// read; where these differ there is a pair of texts (EngineTexts), and functions that SQLite brings and PostgreSQL
/// does not (`instr`, `json_each`, `json_extract`) are made by the migrations of the latter. Parameters are written
/// `?` or `?1`. SQL texts are constants; values are only ever bound.
#include "core/signal/result.hpp"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace driftlab::server {

/// A prepared statement of one engine. A failed bind is reported by the next step.
class EngineStatement {
 public:
  EngineStatement() = default;
  EngineStatement(const EngineStatement&) = delete;
  EngineStatement& operator=(const EngineStatement&) = delete;
  virtual ~EngineStatement() = default;

  virtual void bind_integer(std::int64_t value) = 0;
  virtual void bind_real(double value) = 0;
  virtual void bind_text(std::string_view value) = 0;
  virtual void bind_null() = 0;
  [[nodiscard]] virtual Result<bool> step() = 0;
  [[nodiscard]] virtual Status run();
  [[nodiscard]] virtual std::int64_t integer(int column) const = 0;
  [[nodiscard]] virtual double real(int column) const = 0;
  [[nodiscard]] virtual std::string text(int column) const = 0;
  [[nodiscard]] virtual bool is_null(int column) const = 0;
};

/// A statement to bind values to, in the order of its parameters, and to read rows of. It belongs to its connection.
class Statement {
 public:
  explicit Statement(std::unique_ptr<EngineStatement> engine) : engine_(std::move(engine)) {}

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
  [[nodiscard]] Result<bool> step() { return engine_->step(); }
  /// Runs to the end, ignoring rows. In a write an engine may let it wait for others, so that they travel to the
  /// database in one message: it runs in its turn before a statement that is stepped, `changes` and the end of the
  /// transaction. These tell then that it failed, and whatever the work makes of that, nothing is stored and the
  /// transaction's error is its own.
  [[nodiscard]] Status run() { return engine_->run(); }

  // Columns of the present row, from 0.
  [[nodiscard]] std::int64_t integer(int column) const { return engine_->integer(column); }
  [[nodiscard]] double real(int column) const { return engine_->real(column); }
  [[nodiscard]] std::string text(int column) const { return engine_->text(column); }
  [[nodiscard]] std::optional<std::int64_t> optional_integer(int column) const;

 private:
  std::unique_ptr<EngineStatement> engine_;
};

enum class Engine { Sqlite, Postgres };

/// One statement that the engines write differently. Parameters are the same.
struct EngineTexts {
  std::string_view sqlite;
  std::string_view postgres;
};

/// A connection in a transaction. It belongs to one thread at a time; each text is prepared once and kept.
class Connection {
 public:
  Connection() = default;
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;
  virtual ~Connection() = default;

  [[nodiscard]] Statement prepare(std::string_view sql) { return Statement(make_statement(sql)); }
  [[nodiscard]] Statement prepare(const std::string& sql) { return prepare(std::string_view(sql)); }
  [[nodiscard]] Statement prepare(const char* sql) { return prepare(std::string_view(sql)); }
  [[nodiscard]] Statement prepare(const EngineTexts& texts) {
    return prepare(engine() == Engine::Sqlite ? texts.sqlite : texts.postgres);
  }
  /// The first column of the first row of a query; nothing without rows.
  [[nodiscard]] Result<std::optional<std::int64_t>> query_integer(std::string_view sql);
  [[nodiscard]] Result<std::optional<std::string>> query_text(std::string_view sql);
  /// Rows changed by the latest INSERT, UPDATE or DELETE.
  [[nodiscard]] virtual int changes() = 0;
  [[nodiscard]] virtual Engine engine() const = 0;

 protected:
  [[nodiscard]] virtual std::unique_ptr<EngineStatement> make_statement(std::string_view sql) = 0;
};

}  // namespace driftlab::server
