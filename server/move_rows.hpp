#pragma once
/// Copies every row of one database of the store into another one, of the same engine or not.
///
/// Rows go in the order of their keys, 500 in a transaction, so that what the target holds is always a beginning of
/// what the source holds: a run that was cut off is gone on with behind the last row. Tables come in an order in which
/// nothing is named before it is there. Neither database may be in use meanwhile.
#include "core/signal/result.hpp"
#include "server/store/sql/database.hpp"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace driftlab::server {

struct MovedTable {
  std::string_view name;
  std::string_view keys;  ///< columns of the primary key, with commas between them
};

/// Every table that both engines have, in the order of their copying.
[[nodiscard]] const std::vector<MovedTable>& moved_tables();

struct MovedRows {
  std::int64_t rows = 0;      ///< in the source
  std::int64_t new_rows = 0;  ///< copied now
};

/// Copies what is missing. Errors: those of the databases; Conflict (a table that `moved_tables` does not name, or
/// whose columns differ).
[[nodiscard]] Result<MovedRows> copy_rows(Database& from, Database& to);

/// Compares all tables by their number of rows and the SHA-256 of their values. Errors: Conflict (naming the table).
[[nodiscard]] Status compare_rows(Database& from, Database& to);

/// Whether no table has a row.
[[nodiscard]] Result<bool> has_no_rows(Database& database);

}  // namespace driftlab::server
