#include "server/store/sql/connection.hpp"

namespace driftlab::server {

Status EngineStatement::run() {
  while (true) {
    const Result<bool> row = step();
    if (!row) {
      return fail(row.error());
    }
    if (!*row) {
      return {};
    }
  }
}

Statement& Statement::bind(std::int64_t value) {
  engine_->bind_integer(value);
  return *this;
}

Statement& Statement::bind(double value) {
  engine_->bind_real(value);
  return *this;
}

Statement& Statement::bind(std::string_view value) {
  engine_->bind_text(value);
  return *this;
}

Statement& Statement::bind_null() {
  engine_->bind_null();
  return *this;
}

std::optional<std::int64_t> Statement::optional_integer(int column) const {
  return engine_->is_null(column) ? std::nullopt : std::optional(integer(column));
}

Result<std::optional<std::int64_t>> Connection::query_integer(std::string_view sql) {
  Statement statement = prepare(sql);
  const Result<bool> row = statement.step();
  if (!row) {
    return fail(row.error());
  }
  return *row ? std::optional(statement.integer(0)) : std::nullopt;
}

Result<std::optional<std::string>> Connection::query_text(std::string_view sql) {
  Statement statement = prepare(sql);
  const Result<bool> row = statement.step();
  if (!row) {
    return fail(row.error());
  }
  return *row ? std::optional(statement.text(0)) : std::nullopt;
}

}  // namespace driftlab::server
