#pragma once
/// Rows of a statement by the reader of a resource, which returns the row, or a Result where the row has a seal.
#include "core/signal/result.hpp"
#include "server/store/sql/connection.hpp"

#include <optional>
#include <utility>
#include <vector>

namespace driftlab::server::tables {

template <class Read>
struct RowRead {
  using Row = Read;
};
template <class Sound>
struct RowRead<Result<Sound>> {
  using Row = Sound;
};
template <class Read>
using RowOf = typename RowRead<Read>::Row;

/// The present row as `read` finds it.
template <class Read>
[[nodiscard]] Result<RowOf<Read>> present_row(const Statement& statement, Read (*read)(const Statement&)) {
  return read(statement);
}

/// The first row of a query, read by `read`; nothing without rows.
template <class Read>
[[nodiscard]] Result<std::optional<RowOf<Read>>> first_row(Statement& statement, Read (*read)(const Statement&)) {
  const Result<bool> row = statement.step();
  if (!row || !*row) {
    return row ? Result<std::optional<RowOf<Read>>>(std::nullopt) : fail(row.error());
  }
  return present_row(statement, read).map([](RowOf<Read> found) { return std::optional(std::move(found)); });
}

/// The first row of a query; `absent` where there is none.
template <class Read>
[[nodiscard]] Result<RowOf<Read>> one_row(Statement& statement, Read (*read)(const Statement&), Error absent) {
  const Result<bool> row = statement.step();
  if (!row) {
    return fail(row.error());
  }
  if (!*row) {
    return fail(std::move(absent));
  }
  return present_row(statement, read);
}

/// Every row of a query.
template <class Read>
[[nodiscard]] Result<std::vector<RowOf<Read>>> all_rows(Statement& statement, Read (*read)(const Statement&)) {
  std::vector<RowOf<Read>> rows;
  while (true) {
    const Result<bool> row = statement.step();
    if (!row) {
      return fail(row.error());
    }
    if (!*row) {
      return rows;
    }
    Result<RowOf<Read>> found = present_row(statement, read);
    if (!found) {
      return fail(std::move(found.error()));
    }
    rows.push_back(std::move(*found));
  }
}

}  // namespace driftlab::server::tables
