#include "server/store/postgres/migrations.hpp"

#include "server/store/postgres/advisory_locks.hpp"

#include <chrono>
#include <thread>

namespace driftlab::server {
namespace {

constexpr std::string_view kReadOnly =
    "SELECT 1 WHERE pg_is_in_recovery() OR current_setting('transaction_read_only') = 'on'";
constexpr std::string_view kHasSchema = "SELECT 1 WHERE current_schema() IS NOT NULL";
constexpr std::string_view kHasHistory = "SELECT 1 WHERE to_regclass('schema_migrations') IS NOT NULL";
constexpr std::string_view kTableCount =
    "SELECT count(*) FROM pg_catalog.pg_tables WHERE schemaname = current_schema()";
constexpr const char* kMakeHistory =
    "CREATE TABLE schema_migrations (number BIGINT NOT NULL PRIMARY KEY, name TEXT NOT NULL, sha256 TEXT NOT NULL, "
    "applied_at BIGINT NOT NULL)";
constexpr std::string_view kNewest = "SELECT coalesce(max(number), 0) FROM schema_migrations";
constexpr const char* kWaitShortly = "SET LOCAL lock_timeout = 500";
constexpr std::chrono::seconds kPatience{60};
constexpr std::chrono::milliseconds kPause{200};

Result<bool> holds(Connection& connection, std::string_view sql) {
  return connection.query_integer(sql).map([](std::optional<std::int64_t> row) { return row.has_value(); });
}

Status require_writable(PostgresConnection& connection) {
  const auto read_only = holds(connection, kReadOnly);
  if (!read_only) {
    return fail(read_only.error());
  }
  return *read_only ? Status(fail(postgres_error("25006", "", connection.name()))) : Status{};
}

/// A schema with nothing in it but ours.
Status require_empty(PostgresConnection& connection) {
  const auto there = holds(connection, kHasSchema);
  const auto tables = connection.query_integer(kTableCount);
  if (!there || !tables) {
    return fail(there ? tables.error() : there.error());
  }
  const std::vector<ErrorField> fields = {{"database", connection.name()}};
  if (!*there) {
    return fail(ErrorCode::Conflict, "The database " + connection.name() + " has no schema to make tables in.", fields);
  }
  if (tables->value_or(0) > 0) {
    return fail(ErrorCode::Conflict,
                "The database " + connection.name() + " holds tables that driftlab did not make; name an empty one.",
                fields);
  }
  return {};
}

/// The number of the schema, with a table for its history where there was none.
Result<int> schema_of(PostgresConnection& connection, const std::vector<Migration>& migrations) {
  const auto present = holds(connection, kHasHistory);
  if (!present) {
    return fail(present.error());
  }
  if (*present) {
    return verify_history(connection, migrations);
  }
  if (Status empty = require_empty(connection); !empty) {
    return fail(empty.error());
  }
  const auto made = connection.execute(kMakeHistory);
  return made ? Result<int>(0) : fail(made.error());
}

Status apply(PostgresConnection& connection, const Migration& migration) {
  Status applied = connection.execute(migration.sql).map([](const PostgresResult&) {});
  if (applied) {
    applied = remember_migration(connection, migration, connection.begun_at());
  }
  if (!applied) {
    Error error = std::move(applied.error());
    error.message =
        "Migration " + std::to_string(migration.number) + " (" + migration.name + ") failed. " + error.message;
    return fail(std::move(error).with("migration", std::to_string(migration.number)));
  }
  return {};
}

/// That nobody works with the database who could not do so after what is missing.
Status require_compatible(int schema, const std::vector<Migration>& migrations) {
  for (std::size_t i = static_cast<std::size_t>(schema); i < migrations.size(); ++i) {
    if (oldest_beside(migrations[i]) > schema) {
      return refuse_schema("The database has schema " + std::to_string(schema) +
                               ", and the daemons and workers that are there could not work with it after migration " +
                               std::to_string(migrations[i].number) + " (" + migrations[i].name +
                               "); stop all of them before this driftlab starts.",
                           schema, static_cast<int>(migrations.size()));
    }
  }
  return {};
}

Result<PostgresSchema> apply_missing(PostgresConnection& connection, const std::vector<Migration>& migrations,
                                     bool is_alone) {
  if (Status writable = require_writable(connection); !writable) {
    return fail(writable.error());
  }
  const auto schema = schema_of(connection, migrations);
  if (!schema) {
    return fail(schema.error());
  }
  const int newest = static_cast<int>(migrations.size());
  if (*schema >= newest) {
    return PostgresSchema{*schema, *schema};
  }
  if (Status compatible = is_alone || *schema == 0 ? Status{} : require_compatible(*schema, migrations); !compatible) {
    return fail(compatible.error());
  }
  if (auto limited = connection.execute(kWaitShortly); !limited) {
    return fail(limited.error());
  }
  for (auto next = migrations.begin() + *schema; next != migrations.end(); ++next) {
    if (Status applied = apply(connection, *next); !applied) {
      return fail(applied.error());
    }
  }
  return PostgresSchema{*schema, newest};
}

Result<PostgresSchema> migrate_once(PostgresConnection& connection, const std::vector<Migration>& migrations,
                                    bool is_alone) {
  if (Status begun = connection.begin(advisory_locks::kBeginMigration); !begun) {
    return fail(begun.error());
  }
  auto outcome = apply_missing(connection, migrations, is_alone);
  if (outcome) {
    if (Status ended = connection.commit(); !ended) {
      outcome = fail(ended.error());
    }
  }
  connection.roll_back();
  return outcome;
}

/// A lock that somebody holds, or a deadlock with who works.
bool is_in_the_way(std::string_view sqlstate) { return sqlstate == "55P03" || sqlstate == "40P01"; }

}  // namespace

Result<PostgresSchema> migrate(PostgresConnection& connection, const std::vector<Migration>& migrations,
                               bool is_alone) {
  const auto deadline = std::chrono::steady_clock::now() + kPatience;
  while (true) {
    auto outcome = migrate_once(connection, migrations, is_alone);
    if (outcome || !is_in_the_way(connection.failure()) || std::chrono::steady_clock::now() >= deadline) {
      return outcome;
    }
    std::this_thread::sleep_for(kPause);
  }
}

Result<int> require_schema(Connection& connection, const std::vector<Migration>& migrations) {
  const auto found = connection.query_integer(kNewest);
  if (!found) {
    return fail(found.error());
  }
  const int newest = static_cast<int>(migrations.size());
  const int schema = static_cast<int>(found->value_or(0));
  if (schema == newest) {
    return schema;
  }
  const auto beside = schema > newest ? may_work_beside(connection, newest, schema) : Result<bool>(false);
  if (!beside) {
    return fail(beside.error());
  }
  if (*beside) {
    return schema;
  }
  return refuse_schema("The database has schema " + std::to_string(schema) + " by now, and this driftlab works with " +
                           std::to_string(newest) + "; start the driftlab that belongs to it.",
                       schema, newest);
}

}  // namespace driftlab::server
