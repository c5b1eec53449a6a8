#pragma once
/// Brings one database of the store to what another one holds, of the same engine or not.
///
/// Both are walked in the order of their keys. Rows that the target has and the source has not are removed, those that
/// differ are given the values of the source, those that are missing are added: at first that is every row, later what
/// has changed since, and what a run that was cut off had not copied yet. Five hundred rows go in a transaction. Every
/// row is compared value by value: as it was found, or as it is read back; and so are the numbers of rows.
#include "core/signal/result.hpp"
#include "server/moved_tables.hpp"
#include "server/store/sql/database.hpp"

#include <cstdint>
#include <vector>

namespace driftlab::server {

struct MovedRows {
  std::int64_t rows = 0;  ///< in the source
  std::int64_t added = 0;
  std::int64_t changed = 0;
  std::int64_t removed = 0;
};

/// The source may be at work: all is read over one snapshot of it. The target may not. `tables` are those of both.
/// Errors: those of the databases (Internal: rows that cannot take their new values); Conflict (rows that are not what
/// was written; a target that holds the log of another store).
[[nodiscard]] Result<MovedRows> copy_rows(Database& from, Database& to, const std::vector<MovedTable>& tables);

}  // namespace driftlab::server
