#pragma once
/// The tables of a store as a move sees them: rows of values in the order of their keys, on either engine.
#include "core/signal/result.hpp"
#include "server/store/sql/database.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace driftlab::server {

using MovedValue = std::variant<std::monostate, std::int64_t, double, std::string>;
using MovedRow = std::vector<MovedValue>;

struct MovedColumn {
  std::string name;
  char type = 'T';  ///< the first letter of INTEGER, REAL, TEXT
  bool operator==(const MovedColumn&) const = default;
};

struct MovedTable {
  std::string_view name;
  std::vector<MovedColumn> columns;
  std::vector<std::string> keys;  ///< columns of the primary key

  [[nodiscard]] MovedRow key_of(const MovedRow& row) const;
};

/// Every table that both databases have, in an order in which nothing is named before it is there. Errors: those of
/// the databases; Conflict (a table that is not known here, or whose columns differ).
[[nodiscard]] Result<std::vector<MovedTable>> moved_tables(Database& from, Database& to);
[[nodiscard]] int moved_table_count();

/// The next 500 rows behind a key; from the first where there is none.
[[nodiscard]] Result<std::vector<MovedRow>> rows_behind(Connection& connection, const MovedTable& table,
                                                        const std::optional<MovedRow>& key);
/// The rows of these keys, in the order of their keys, as far as they are there.
[[nodiscard]] Result<std::vector<MovedRow>> rows_of(Connection& connection, const MovedTable& table,
                                                    std::span<const MovedRow> keys);
/// Lets the transaction that reads a snapshot wait for as long as its rows are written elsewhere.
[[nodiscard]] Status wait_within_snapshot(Connection& connection);
[[nodiscard]] Result<std::int64_t> row_count(Database& database, const MovedTable& table);

[[nodiscard]] Status insert_row(Connection& connection, const MovedTable& table, const MovedRow& row);
/// Gives the row of the same key the other values of `row`.
[[nodiscard]] Status update_row(Connection& connection, const MovedTable& table, const MovedRow& row);
[[nodiscard]] Status delete_row(Connection& connection, const MovedTable& table, const MovedRow& key);

/// New rows of a numbered table get numbers behind those that are there.
[[nodiscard]] Status number_behind(Database& database, const MovedTable& table);

/// Whether no table has a row.
[[nodiscard]] Result<bool> has_no_rows(Database& database);

}  // namespace driftlab::server
