#include "server/move_rows.hpp"

#include "server/moved_tables.hpp"

#include <algorithm>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace driftlab::server {
namespace {

constexpr std::size_t kInOneTransaction = 500;

/// A table read from its first row to its last, some at a time.
class Walk {
 public:
  /// Both must outlive it.
  Walk(Connection& snapshot, const MovedTable& table) : snapshot_(snapshot), table_(table) {}

  /// The row at which it stands; nullptr behind the last one.
  [[nodiscard]] Result<const MovedRow*> row() {
    if (at_ == rows_.size() && !ended_) {
      auto more = rows_behind(snapshot_, table_, key_);
      if (!more) {
        return fail(more.error());
      }
      rows_ = *std::move(more);
      at_ = 0;
      ended_ = rows_.empty();
      key_ = ended_ ? key_ : std::optional(table_.key_of(rows_.back()));
    }
    return ended_ ? nullptr : &rows_[at_];
  }
  void step() { ++at_; }

 private:
  Connection& snapshot_;
  const MovedTable& table_;
  std::vector<MovedRow> rows_;
  std::size_t at_ = 0;
  std::optional<MovedRow> key_;
  bool ended_ = false;
};

/// Keys of the rows of a table in which the target is not what the source is.
struct Differences {
  std::vector<MovedRow> gone;
  std::vector<MovedRow> changed;
  std::vector<MovedRow> missing;
  std::optional<MovedRow> last;  ///< of the target; behind it everything is missing
  std::int64_t rows = 0;         ///< of the source, as far as `last`
};

Result<Differences> differences_of(Connection& source, Connection& target, const MovedTable& table) {
  Differences found;
  Walk here(source, table);
  Walk there(target, table);
  while (true) {
    const auto wanted = here.row();
    const auto held = there.row();
    if (!wanted || !held) {
      return fail(wanted ? held.error() : wanted.error());
    }
    if (*held == nullptr) {
      return found;
    }
    MovedRow held_key = table.key_of(**held);
    found.last = held_key;
    if (*wanted == nullptr) {
      found.gone.push_back(std::move(held_key));
      there.step();
      continue;
    }
    MovedRow wanted_key = table.key_of(**wanted);
    if (held_key < wanted_key) {
      found.gone.push_back(std::move(held_key));
      there.step();
      continue;
    }
    if (held_key == wanted_key) {
      if (**held != **wanted) {
        found.changed.push_back(std::move(wanted_key));
      }
      there.step();
    } else {
      found.missing.push_back(std::move(wanted_key));
    }
    ++found.rows;
    here.step();
  }
}

using Change = Status (*)(Connection&, const MovedTable&, const MovedRow&);

Status in_one(Database& database, const MovedTable& table, std::span<const MovedRow> rows, Change change) {
  return database
      .write(WriteKind::Fenced,
             [&](Connection& connection) -> Result<int> {
               for (const MovedRow& row : rows) {
                 if (Status changed = change(connection, table, row); !changed) {
                   return fail(changed.error());
                 }
               }
               return 0;
             })
      .map([](int) {});
}

/// Rows that have to wait for others of theirs, whose values they take or which they are named by: as many rounds as
/// that takes.
Status in_rounds(Database& database, const MovedTable& table, std::vector<MovedRow> rows, Change change) {
  const std::span<const MovedRow> all(rows);
  std::size_t done = 0;
  for (; done < rows.size(); done += kInOneTransaction) {
    if (!in_one(database, table, all.subspan(done, std::min(kInOneTransaction, rows.size() - done)), change)) {
      break;
    }
  }
  rows.erase(rows.begin(), rows.begin() + static_cast<std::ptrdiff_t>(std::min(done, rows.size())));
  while (!rows.empty()) {
    std::vector<MovedRow> waiting;
    Status failed;
    for (MovedRow& row : rows) {
      if (Status changed = in_one(database, table, {&row, 1}, change); !changed) {
        failed = std::move(changed);
        waiting.push_back(std::move(row));
      }
    }
    if (waiting.size() == rows.size()) {
      return failed;
    }
    rows = std::move(waiting);
  }
  return {};
}

Status check_same(const MovedTable& table, const Result<std::vector<MovedRow>>& there,
                  const std::vector<MovedRow>& here) {
  if (!there) {
    return fail(there.error());
  }
  return *there == here ? Status{}
                        : fail(ErrorCode::Conflict,
                               "Rows of the table " + std::string(table.name) +
                                   " are not what was written; begin again with an empty target.",
                               {{"table", std::string(table.name)}});
}

/// Gives the target the rows of these keys as the source has them, and reads them back.
Status bring(Connection& source, Database& target, const MovedTable& table, std::span<const MovedRow> keys,
             Change change) {
  for (std::size_t i = 0; i < keys.size(); i += kInOneTransaction) {
    const auto part = keys.subspan(i, std::min(kInOneTransaction, keys.size() - i));
    const auto rows = rows_of(source, table, part);
    if (!rows) {
      return fail(rows.error());
    }
    if (Status changed = in_rounds(target, table, *rows, change); !changed) {
      return changed;
    }
    const auto read_back = target.read([&](Connection& there) { return rows_of(there, table, part); });
    if (Status same = check_same(table, read_back, *rows); !same) {
      return same;
    }
  }
  return {};
}

/// Adds what is behind the last row of the target; returns how many that were.
Result<std::int64_t> append_rows(Connection& source, Database& target, const MovedTable& table,
                                 std::optional<MovedRow> last) {
  std::int64_t count = 0;
  while (true) {
    const auto rows = rows_behind(source, table, last);
    if (!rows) {
      return fail(rows.error());
    }
    if (rows->empty()) {
      return count;
    }
    if (Status inserted = in_one(target, table, *rows, &insert_row); !inserted) {
      return fail(inserted.error());
    }
    const auto read_back = target.read([&](Connection& there) { return rows_behind(there, table, last); });
    if (Status same = check_same(table, read_back, *rows); !same) {
      return fail(same.error());
    }
    count += static_cast<std::int64_t>(rows->size());
    last = table.key_of(rows->back());
  }
}

Status check_count(Database& target, const MovedTable& table, std::int64_t rows) {
  const auto there = row_count(target, table);
  if (!there) {
    return fail(there.error());
  }
  return *there == rows
             ? Status{}
             : fail(ErrorCode::Conflict,
                    "The table " + std::string(table.name) + " has " + std::to_string(rows) + " rows here and " +
                        std::to_string(*there) + " there; begin again with an empty target.",
                    {{"table", std::string(table.name)}});
}

Status mend_table(Connection& source, Database& target, const MovedTable& table, const Differences& differences,
                  MovedRows& moved) {
  if (Status changed = bring(source, target, table, differences.changed, &update_row); !changed) {
    return changed;
  }
  if (Status added = bring(source, target, table, differences.missing, &insert_row); !added) {
    return added;
  }
  const auto appended = append_rows(source, target, table, differences.last);
  if (!appended) {
    return fail(appended.error());
  }
  moved.changed += static_cast<std::int64_t>(differences.changed.size());
  moved.added += static_cast<std::int64_t>(differences.missing.size()) + *appended;
  const std::int64_t rows = differences.rows + *appended;
  moved.rows += rows;
  if (Status counted = check_count(target, table, rows); !counted) {
    return counted;
  }
  return number_behind(target, table);
}

/// What a log says is never taken back: where the target's has other rows, it is no beginning of this source.
Status check_log(const MovedTable& table, const Differences& differences) {
  return table.name != "audit" || (differences.gone.empty() && differences.changed.empty())
             ? Status{}
             : fail(ErrorCode::Conflict,
                    "The audit log of the target is not that of the source; begin again with an empty target.",
                    {{"table", std::string(table.name)}});
}

/// Of each of the tables.
Result<std::vector<Differences>> all_differences(Connection& source, Database& target,
                                                 const std::vector<MovedTable>& tables) {
  return target.read([&](Connection& there) -> Result<std::vector<Differences>> {
    if (Status patient = wait_within_snapshot(there); !patient) {
      return fail(patient.error());
    }
    std::vector<Differences> all;
    for (const MovedTable& table : tables) {
      auto found = differences_of(source, there, table);
      if (!found) {
        return fail(found.error());
      }
      if (Status checked = check_log(table, *found); !checked) {
        return fail(checked.error());
      }
      all.push_back(*std::move(found));
    }
    return all;
  });
}

/// Rows go before those that they name, and come behind them.
Result<MovedRows> copy_snapshot(Connection& source, Database& target, const std::vector<MovedTable>& tables) {
  const auto differences = all_differences(source, target, tables);
  if (!differences) {
    return fail(differences.error());
  }
  MovedRows moved;
  for (std::size_t i = tables.size(); i-- > 0;) {
    const std::vector<MovedRow>& gone = (*differences)[i].gone;
    moved.removed += static_cast<std::int64_t>(gone.size());
    // The newest first, for they may name older ones.
    if (Status removed = in_rounds(target, tables[i], {gone.rbegin(), gone.rend()}, &delete_row); !removed) {
      return fail(removed.error());
    }
  }
  for (std::size_t i = 0; i < tables.size(); ++i) {
    if (Status mended = mend_table(source, target, tables[i], (*differences)[i], moved); !mended) {
      return fail(mended.error());
    }
  }
  return moved;
}

}  // namespace

Result<MovedRows> copy_rows(Database& from, Database& to, const std::vector<MovedTable>& tables) {
  return from.read([&](Connection& source) -> Result<MovedRows> {
    if (Status patient = wait_within_snapshot(source); !patient) {
      return fail(patient.error());
    }
    return copy_snapshot(source, to, tables);
  });
}

}  // namespace driftlab::server
