#include "server/moved_tables.hpp"

#include <algorithm>
#include <array>
#include <iterator>

namespace driftlab::server {
namespace {

constexpr int kRowsAtOnce = 500;
constexpr std::size_t kKeysAtOnce = 100;

struct KnownTable {
  std::string_view name;
  std::string_view keys;  ///< with commas between them
};

constexpr std::array kKnownTables{
    KnownTable{"devices", "id"},
    KnownTable{"blobs", "sha256"},
    KnownTable{"recordings", "id"},
    KnownTable{"jobs", "id"},
    KnownTable{"job_events", "sequence"},
    KnownTable{"job_attempts", "job_id,attempt"},
    KnownTable{"job_parts", "job_id,number"},
    KnownTable{"job_results", "job_id"},
    KnownTable{"channel_results", "sequence"},
    KnownTable{"fits", "id"},
    KnownTable{"idempotent_replies", "key"},
    KnownTable{"studies", "id"},
    KnownTable{"calibrations", "id"},
    KnownTable{"models", "id"},
    KnownTable{"investigations", "id"},
    KnownTable{"pools", "device_id,quantity,axis"},
    KnownTable{"tokens", "id"},
    KnownTable{"sessions", "secret_sha256"},
    KnownTable{"audit", "sequence"},
    KnownTable{"owners", "object_id,token_id"},
    KnownTable{"job_devices", "job_id,device_id"},
    KnownTable{"anchors", "id"},
    KnownTable{"artefacts", "job_id,name"},
    KnownTable{"webhooks", "id"},
    KnownTable{"webhook_deliveries", "id"},
    KnownTable{"drives", "id"},
    KnownTable{"verdicts", "id"},
    KnownTable{"job_recordings", "job_id,recording_id"},
};

// Tables that are of one engine alone, or that triggers keep, are not moved.
// The texts of this file are put together from names of tables and columns that the catalogue of the database gives and
// this list confirms; values are bound as everywhere.
constexpr EngineTexts kColumns{
    "SELECT name, type FROM pragma_table_info(?1) ORDER BY name",
    "SELECT column_name::TEXT, CASE data_type WHEN 'bigint' THEN 'INTEGER' WHEN 'double precision' THEN 'REAL' ELSE "
    "'TEXT' END FROM information_schema.columns WHERE table_schema = current_schema() AND table_name = ?1 ORDER BY "
    "column_name COLLATE \"C\""};
constexpr EngineTexts kTables{
    "SELECT name FROM sqlite_schema WHERE type = 'table' AND name NOT LIKE 'sqlite%' AND name NOT IN "
    "('schema_migrations', 'commits', 'recordings_without_result', 'stored_amounts')",
    "SELECT tablename::TEXT FROM pg_catalog.pg_tables WHERE schemaname = current_schema() AND tablename NOT IN "
    "('schema_migrations', 'store_identity', 'stored_files', 'stored_file_parts', 'recordings_without_result', "
    "'stored_amounts')"};
constexpr std::string_view kSetSequence = "SELECT setval(pg_get_serial_sequence(?1, 'sequence'), greatest(1, ?2))";

std::vector<std::string> split_names(std::string_view names) {
  std::vector<std::string> parts;
  while (!names.empty()) {
    const std::size_t comma = std::min(names.find(','), names.size());
    parts.emplace_back(names.substr(0, comma));
    names.remove_prefix(std::min(comma + 1, names.size()));
  }
  return parts;
}

std::string joined(const std::vector<std::string>& parts, std::string_view behind_each = "",
                   std::string_view between = ", ") {
  std::string text;
  for (const std::string& part : parts) {
    text.append(text.empty() ? "" : between).append(part).append(behind_each);
  }
  return text;
}

std::string places(std::size_t count) { return joined(std::vector<std::string>(count, "?")); }

std::string names_of(const MovedTable& table) {
  std::vector<std::string> all;
  for (const MovedColumn& column : table.columns) {
    all.push_back(column.name);
  }
  return joined(all);
}

std::string where_key(const MovedTable& table) { return " WHERE " + joined(table.keys, " = ?", " AND "); }

Result<std::vector<MovedColumn>> columns_of(Connection& connection, std::string_view table) {
  Statement statement = connection.prepare(kColumns);
  statement.bind(table);
  std::vector<MovedColumn> columns;
  while (true) {
    const auto row = statement.step();
    if (!row || !*row) {
      return row ? Result<std::vector<MovedColumn>>(std::move(columns)) : fail(row.error());
    }
    columns.push_back({statement.text(0), statement.text(1).empty() ? 'T' : statement.text(1).front()});
  }
}

/// Those of each table of kKnownTables. Error also: Conflict (there is another table).
Result<std::vector<std::vector<MovedColumn>>> catalogue_of(Connection& connection) {
  Statement statement = connection.prepare(kTables);
  while (true) {
    const auto row = statement.step();
    if (!row) {
      return fail(row.error());
    }
    if (!*row) {
      break;
    }
    const std::string name = statement.text(0);
    if (std::none_of(kKnownTables.begin(), kKnownTables.end(),
                     [&](const KnownTable& table) { return table.name == name; })) {
      return fail(ErrorCode::Conflict, "The table " + name + " is not one that can be moved.", {{"table", name}});
    }
  }
  std::vector<std::vector<MovedColumn>> all;
  for (const KnownTable& each : kKnownTables) {
    auto columns = columns_of(connection, each.name);
    if (!columns) {
      return fail(columns.error());
    }
    all.push_back(*std::move(columns));
  }
  return all;
}

void bind_value(Statement& statement, const MovedValue& value) {
  if (const auto* const whole = std::get_if<std::int64_t>(&value)) {
    statement.bind(*whole);
  } else if (const auto* const real = std::get_if<double>(&value)) {
    statement.bind(*real);
  } else if (const auto* const text = std::get_if<std::string>(&value)) {
    statement.bind(*text);
  } else {
    statement.bind_null();
  }
}

MovedValue read_value(const Statement& row, int index, char type) {
  if (!row.optional_integer(index)) {
    return {};
  }
  return type == 'I'   ? MovedValue(row.integer(index))
         : type == 'R' ? MovedValue(row.real(index))
                       : MovedValue(row.text(index));
}

/// Every row of a SELECT of `names_of(table)` whose places are those of `values`.
Result<std::vector<MovedRow>> selected(Connection& connection, const MovedTable& table, const std::string& text,
                                       const MovedRow& values) {
  Statement statement = connection.prepare(text);
  for (const MovedValue& value : values) {
    bind_value(statement, value);
  }
  std::vector<MovedRow> rows;
  while (true) {
    const auto found = statement.step();
    if (!found || !*found) {
      return found ? Result<std::vector<MovedRow>>(std::move(rows)) : fail(found.error());
    }
    MovedRow row;
    for (std::size_t i = 0; i < table.columns.size(); ++i) {
      row.push_back(read_value(statement, static_cast<int>(i), table.columns[i].type));
    }
    rows.push_back(std::move(row));
  }
}

Status run_with(Connection& connection, const std::string& text, const MovedRow& values) {
  Statement statement = connection.prepare(text);
  for (const MovedValue& value : values) {
    bind_value(statement, value);
  }
  return statement.run();
}

/// One whole number of a table.
Result<std::int64_t> number_of(Database& database, const MovedTable& table, const std::string& what) {
  const std::string text = "SELECT " + what + " FROM " + std::string(table.name);
  return database.read([&](Connection& connection) -> Result<std::int64_t> {
    return connection.query_integer(text).map([](std::optional<std::int64_t> number) { return number.value_or(0); });
  });
}

}  // namespace

MovedRow MovedTable::key_of(const MovedRow& row) const {
  MovedRow key;
  for (const std::string& wanted : keys) {
    const auto column =
        std::find_if(columns.begin(), columns.end(), [&](const MovedColumn& each) { return each.name == wanted; });
    key.push_back(row[static_cast<std::size_t>(column - columns.begin())]);
  }
  return key;
}

Result<std::vector<MovedTable>> moved_tables(Database& from, Database& to) {
  auto here = from.read(&catalogue_of);
  const auto there = to.read(&catalogue_of);
  if (!here || !there) {
    return fail(here ? there.error() : here.error());
  }
  std::vector<MovedTable> tables;
  for (std::size_t i = 0; i < kKnownTables.size(); ++i) {
    const std::string name(kKnownTables[i].name);
    if ((*here)[i].empty() || (*here)[i] != (*there)[i]) {
      return fail(ErrorCode::Conflict, "The table " + name + " is another one in the two stores.", {{"table", name}});
    }
    tables.push_back({kKnownTables[i].name, std::move((*here)[i]), split_names(kKnownTables[i].keys)});
  }
  return tables;
}

int moved_table_count() { return static_cast<int>(kKnownTables.size()); }

Result<std::vector<MovedRow>> rows_behind(Connection& connection, const MovedTable& table,
                                          const std::optional<MovedRow>& key) {
  const std::string text = "SELECT " + names_of(table) + " FROM " + std::string(table.name) +
                           (key ? " WHERE (" + joined(table.keys) + ") > (" + places(key->size()) + ")" : "") +
                           " ORDER BY " + joined(table.keys) + " LIMIT " + std::to_string(kRowsAtOnce);
  return selected(connection, table, text, key.value_or(MovedRow{}));
}

Result<std::vector<MovedRow>> rows_of(Connection& connection, const MovedTable& table, std::span<const MovedRow> keys) {
  std::vector<MovedRow> all;
  for (; !keys.empty(); keys = keys.subspan(std::min(keys.size(), kKeysAtOnce))) {
    std::vector<std::string> alternatives;
    MovedRow values;
    for (const MovedRow& key : keys.first(std::min(keys.size(), kKeysAtOnce))) {
      alternatives.push_back("(" + joined(table.keys, " = ?", " AND ") + ")");
      values.insert(values.end(), key.begin(), key.end());
    }
    const std::string text = "SELECT " + names_of(table) + " FROM " + std::string(table.name) + " WHERE " +
                             joined(alternatives, "", " OR ") + " ORDER BY " + joined(table.keys);
    auto rows = selected(connection, table, text, values);
    if (!rows) {
      return fail(rows.error());
    }
    all.insert(all.end(), std::make_move_iterator(rows->begin()), std::make_move_iterator(rows->end()));
  }
  return all;
}

Status wait_within_snapshot(Connection& connection) {
  return connection.engine() == Engine::Postgres
             ? connection.prepare("SET LOCAL idle_in_transaction_session_timeout = 0").run()
             : Status{};
}

Result<std::int64_t> row_count(Database& database, const MovedTable& table) {
  return number_of(database, table, "count(*)");
}

Status insert_row(Connection& connection, const MovedTable& table, const MovedRow& row) {
  return run_with(connection,
                  "INSERT INTO " + std::string(table.name) + " (" + names_of(table) + ") VALUES (" +
                      places(table.columns.size()) + ")",
                  row);
}

Status update_row(Connection& connection, const MovedTable& table, const MovedRow& row) {
  std::vector<std::string> others;
  MovedRow values;
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    if (std::find(table.keys.begin(), table.keys.end(), table.columns[i].name) == table.keys.end()) {
      others.push_back(table.columns[i].name);
      values.push_back(row[i]);
    }
  }
  for (MovedValue& value : table.key_of(row)) {
    values.push_back(std::move(value));
  }
  return run_with(connection, "UPDATE " + std::string(table.name) + " SET " + joined(others, " = ?") + where_key(table),
                  values);
}

Status delete_row(Connection& connection, const MovedTable& table, const MovedRow& key) {
  return run_with(connection, "DELETE FROM " + std::string(table.name) + where_key(table), key);
}

Status number_behind(Database& database, const MovedTable& table) {
  if (table.keys.front() != "sequence" || table.name == "audit") {
    return {};
  }
  const auto newest = number_of(database, table, "coalesce(max(sequence), 0)");
  if (!newest) {
    return fail(newest.error());
  }
  return database
      .write(WriteKind::Fenced,
             [&](Connection& connection) -> Result<int> {
               if (connection.engine() == Engine::Postgres && *newest > 0) {
                 Statement statement = connection.prepare(kSetSequence);
                 statement.bind(table.name, *newest);
                 if (const auto row = statement.step(); !row) {
                   return fail(row.error());
                 }
               }
               return 0;
             })
      .map([](int) {});
}

Result<bool> has_no_rows(Database& database) {
  return database.read([](Connection& connection) -> Result<bool> {
    for (const KnownTable& table : kKnownTables) {
      const std::string text = "SELECT count(*) FROM (SELECT 1 FROM " + std::string(table.name) + " LIMIT 1) AS first";
      const auto some = connection.query_integer(text);
      if (!some) {
        return fail(some.error());
      }
      if (some->value_or(0) > 0) {
        return false;
      }
    }
    return true;
  });
}

}  // namespace driftlab::server
