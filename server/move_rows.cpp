#include "server/move_rows.hpp"

#include "server/store/digest.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>
#include <span>
#include <variant>

namespace driftlab::server {
namespace {

constexpr int kRowsAtOnce = 500;

// The texts of this file are put together from names of tables and columns that the catalogue of the database gives and
// this list confirms; values are bound as everywhere.
constexpr EngineTexts kColumns{
    "SELECT name, type FROM pragma_table_info(?1) ORDER BY name",
    "SELECT column_name::TEXT, CASE data_type WHEN 'bigint' THEN 'INTEGER' WHEN 'double precision' THEN 'REAL' ELSE "
    "'TEXT' END FROM information_schema.columns WHERE table_schema = current_schema() AND table_name = ?1 ORDER BY "
    "column_name COLLATE \"C\""};
constexpr EngineTexts kTables{
    "SELECT name FROM sqlite_schema WHERE type = 'table' AND name NOT LIKE 'sqlite%' AND name NOT IN "
    "('schema_migrations', 'commits')",
    "SELECT tablename::TEXT FROM pg_catalog.pg_tables WHERE schemaname = current_schema() AND tablename NOT IN "
    "('schema_migrations', 'store_identity', 'stored_files', 'stored_file_parts')"};
constexpr std::string_view kSetSequence = "SELECT setval(pg_get_serial_sequence(?1, 'sequence'), greatest(1, ?2))";

using Value = std::variant<std::monostate, std::int64_t, double, std::string>;
using Row = std::vector<Value>;

struct Column {
  std::string name;
  char type = 'T';  ///< the first letter of INTEGER, REAL, TEXT
  bool operator==(const Column&) const = default;
};

std::vector<std::string> split_names(std::string_view names) {
  std::vector<std::string> parts;
  while (!names.empty()) {
    const std::size_t comma = std::min(names.find(','), names.size());
    parts.emplace_back(names.substr(0, comma));
    names.remove_prefix(std::min(comma + 1, names.size()));
  }
  return parts;
}

std::string joined(const std::vector<std::string>& parts, std::string_view behind_each = "") {
  std::string text;
  for (const std::string& part : parts) {
    text += (text.empty() ? "" : ", ") + part + std::string(behind_each);
  }
  return text;
}

std::string places(std::size_t count) { return joined(std::vector<std::string>(count, "?")); }

Result<std::vector<Column>> columns_of(Database& database, std::string_view table) {
  return database.read([&](Connection& connection) -> Result<std::vector<Column>> {
    Statement statement = connection.prepare(kColumns);
    statement.bind(table);
    std::vector<Column> columns;
    while (true) {
      const auto row = statement.step();
      if (!row || !*row) {
        return row ? Result<std::vector<Column>>(std::move(columns)) : fail(row.error());
      }
      columns.push_back({statement.text(0), statement.text(1).empty() ? 'T' : statement.text(1).front()});
    }
  });
}

void bind_value(Statement& statement, const Value& value) {
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

Value read_value(const Statement& row, int index, char type) {
  if (!row.optional_integer(index)) {
    return {};
  }
  return type == 'I' ? Value(row.integer(index)) : type == 'R' ? Value(row.real(index)) : Value(row.text(index));
}

/// A table as it is read: its columns and which of them are its key.
struct Table {
  std::string_view name;
  std::vector<Column> columns;
  std::vector<std::string> keys;

  [[nodiscard]] std::vector<std::string> names() const {
    std::vector<std::string> all;
    for (const Column& column : columns) {
      all.push_back(column.name);
    }
    return all;
  }
  [[nodiscard]] Row key_of(const Row& row) const {
    Row key;
    for (const std::string& wanted : keys) {
      const auto column =
          std::find_if(columns.begin(), columns.end(), [&](const Column& each) { return each.name == wanted; });
      key.push_back(row[static_cast<std::size_t>(column - columns.begin())]);
    }
    return key;
  }
};

/// The next rows behind a key; from the first where there is none.
Result<std::vector<Row>> rows_behind(Database& database, const Table& table, const std::optional<Row>& key) {
  const std::string text = "SELECT " + joined(table.names()) + " FROM " + std::string(table.name) +
                           (key ? " WHERE (" + joined(table.keys) + ") > (" + places(key->size()) + ")" : "") +
                           " ORDER BY " + joined(table.keys) + " LIMIT " + std::to_string(kRowsAtOnce);
  return database.read([&](Connection& connection) -> Result<std::vector<Row>> {
    Statement statement = connection.prepare(text);
    for (const Value& value : key.value_or(Row{})) {
      bind_value(statement, value);
    }
    std::vector<Row> rows;
    while (true) {
      const auto found = statement.step();
      if (!found || !*found) {
        return found ? Result<std::vector<Row>>(std::move(rows)) : fail(found.error());
      }
      Row row;
      for (std::size_t i = 0; i < table.columns.size(); ++i) {
        row.push_back(read_value(statement, static_cast<int>(i), table.columns[i].type));
      }
      rows.push_back(std::move(row));
    }
  });
}

Result<std::optional<Row>> last_key(Database& database, const Table& table) {
  const std::string text = "SELECT " + joined(table.names()) + " FROM " + std::string(table.name) + " ORDER BY " +
                           joined(table.keys, " DESC") + " LIMIT 1";
  return database.read([&](Connection& connection) -> Result<std::optional<Row>> {
    Statement statement = connection.prepare(text);
    const auto found = statement.step();
    if (!found || !*found) {
      return found ? Result<std::optional<Row>>(std::nullopt) : fail(found.error());
    }
    Row row;
    for (std::size_t i = 0; i < table.columns.size(); ++i) {
      row.push_back(read_value(statement, static_cast<int>(i), table.columns[i].type));
    }
    return table.key_of(row);
  });
}

Status insert_rows(Database& database, const Table& table, const std::vector<Row>& rows) {
  const std::string text = "INSERT INTO " + std::string(table.name) + " (" + joined(table.names()) + ") VALUES (" +
                           places(table.columns.size()) + ")";
  return database
      .write(WriteKind::Fenced,
             [&](Connection& connection) -> Result<int> {
               for (const Row& row : rows) {
                 Statement statement = connection.prepare(text);
                 for (const Value& value : row) {
                   bind_value(statement, value);
                 }
                 if (Status inserted = statement.run(); !inserted) {
                   return fail(inserted.error());
                 }
               }
               return 0;
             })
      .map([](int) {});
}

/// New rows get numbers behind those that were copied.
Status set_sequence(Database& database, const Table& table) {
  const auto key = last_key(database, table);
  if (!key) {
    return fail(key.error());
  }
  const std::optional<Row>& last = *key;
  if (!last || table.keys.front() != "sequence") {
    return {};
  }
  const std::int64_t newest = std::get<std::int64_t>(last->front());
  return database
      .write(WriteKind::Fenced,
             [&](Connection& connection) -> Result<int> {
               if (connection.engine() == Engine::Postgres && table.name != "audit") {
                 Statement statement = connection.prepare(kSetSequence);
                 statement.bind(table.name, newest);
                 if (const auto row = statement.step(); !row) {
                   return fail(row.error());
                 }
               }
               return 0;
             })
      .map([](int) {});
}

/// All tables with their columns, which both databases must agree on.
Result<std::vector<Table>> tables_of(Database& from, Database& to) {
  const auto listed = from.read([](Connection& connection) -> Result<std::vector<std::string>> {
    Statement statement = connection.prepare(kTables);
    std::vector<std::string> names;
    while (true) {
      const auto row = statement.step();
      if (!row || !*row) {
        return row ? Result<std::vector<std::string>>(std::move(names)) : fail(row.error());
      }
      names.push_back(statement.text(0));
    }
  });
  if (!listed) {
    return fail(listed.error());
  }
  for (const std::string& name : *listed) {
    const auto& known = moved_tables();
    if (std::none_of(known.begin(), known.end(), [&](const MovedTable& table) { return table.name == name; })) {
      return fail(ErrorCode::Conflict, "The table " + name + " is not one that can be moved.", {{"table", name}});
    }
  }
  std::vector<Table> tables;
  for (const MovedTable& each : moved_tables()) {
    auto here = columns_of(from, each.name);
    const auto there = columns_of(to, each.name);
    if (!here || !there) {
      return fail(here ? there.error() : here.error());
    }
    if (here->empty() || *here != *there) {
      return fail(ErrorCode::Conflict, "The table " + std::string(each.name) + " is another one in the two stores.",
                  {{"table", std::string(each.name)}});
    }
    tables.push_back({each.name, std::move(*here), split_names(each.keys)});
  }
  return tables;
}

/// Rows and their digest: each value with its kind and length, so that different rows have different texts.
struct Contents {
  std::int64_t rows = 0;
  std::string sha256;
};

std::string text_of(const Value& value) {
  if (const auto* const whole = std::get_if<std::int64_t>(&value)) {
    return "i" + std::to_string(*whole) + ";";
  }
  if (const auto* const real = std::get_if<double>(&value)) {
    std::array<char, 32> text{};
    const auto end = std::to_chars(text.data(), text.data() + text.size(), *real);
    return "r" + std::string(text.data(), end.ptr) + ";";
  }
  if (const auto* const text = std::get_if<std::string>(&value)) {
    return "t" + std::to_string(text->size()) + ":" + *text;
  }
  return "n;";
}

Result<Contents> contents_of(Database& database, const Table& table) {
  Contents contents;
  Sha256 digest;
  std::optional<Row> key;
  while (true) {
    const auto rows = rows_behind(database, table, key);
    if (!rows) {
      return fail(rows.error());
    }
    if (rows->empty()) {
      contents.sha256 = digest.finish();
      return contents;
    }
    for (const Row& row : *rows) {
      std::string text;
      for (const Value& value : row) {
        text += text_of(value);
      }
      digest.update(std::as_bytes(std::span(text.data(), text.size())));
    }
    contents.rows += static_cast<std::int64_t>(rows->size());
    key = table.key_of(rows->back());
  }
}

Result<std::int64_t> count_rows(Database& database, std::string_view table) {
  const std::string text = "SELECT count(*) FROM " + std::string(table);
  return database.read([&](Connection& connection) -> Result<std::int64_t> {
    return connection.query_integer(text).map([](std::optional<std::int64_t> count) { return count.value_or(0); });
  });
}

}  // namespace

const std::vector<MovedTable>& moved_tables() {
  static const std::vector<MovedTable> tables = {
      {"devices", "id"},
      {"blobs", "sha256"},
      {"recordings", "id"},
      {"jobs", "id"},
      {"job_events", "sequence"},
      {"job_attempts", "job_id,attempt"},
      {"job_parts", "job_id,number"},
      {"job_results", "job_id"},
      {"channel_results", "sequence"},
      {"fits", "id"},
      {"idempotent_replies", "key"},
      {"studies", "id"},
      {"calibrations", "id"},
      {"models", "id"},
      {"investigations", "id"},
      {"pools", "device_id,quantity,axis"},
      {"tokens", "id"},
      {"sessions", "secret_sha256"},
      {"audit", "sequence"},
      {"owners", "object_id,token_id"},
      {"job_devices", "job_id,device_id"},
      {"anchors", "id"},
      {"artefacts", "job_id,name"},
      {"webhooks", "id"},
      {"webhook_deliveries", "id"},
      {"drives", "id"},
      {"verdicts", "id"},
      {"job_recordings", "job_id,recording_id"},
  };
  return tables;
}

Result<MovedRows> copy_rows(Database& from, Database& to) {
  const auto tables = tables_of(from, to);
  if (!tables) {
    return fail(tables.error());
  }
  MovedRows moved;
  for (const Table& table : *tables) {
    const auto count = count_rows(from, table.name);
    auto key = last_key(to, table);
    if (!count || !key) {
      return fail(count ? key.error() : count.error());
    }
    moved.rows += *count;
    while (true) {
      const auto rows = rows_behind(from, table, *key);
      if (!rows) {
        return fail(rows.error());
      }
      if (rows->empty()) {
        break;
      }
      if (Status inserted = insert_rows(to, table, *rows); !inserted) {
        return fail(inserted.error());
      }
      moved.new_rows += static_cast<std::int64_t>(rows->size());
      key = table.key_of(rows->back());
    }
    if (Status counted = set_sequence(to, table); !counted) {
      return fail(counted.error());
    }
  }
  return moved;
}

Status compare_rows(Database& from, Database& to) {
  const auto tables = tables_of(from, to);
  if (!tables) {
    return fail(tables.error());
  }
  for (const Table& table : *tables) {
    const auto here = contents_of(from, table);
    const auto there = contents_of(to, table);
    if (!here || !there) {
      return fail(here ? there.error() : here.error());
    }
    if (here->rows != there->rows || here->sha256 != there->sha256) {
      return fail(ErrorCode::Conflict,
                  "The table " + std::string(table.name) + " has " + std::to_string(here->rows) + " rows here and " +
                      std::to_string(there->rows) + " there, which are not the same; begin again with an empty target.",
                  {{"table", std::string(table.name)}});
    }
  }
  return {};
}

Result<bool> has_no_rows(Database& database) {
  for (const MovedTable& table : moved_tables()) {
    const auto count = count_rows(database, table.name);
    if (!count) {
      return fail(count.error());
    }
    if (*count > 0) {
      return false;
    }
  }
  return true;
}

}  // namespace driftlab::server
