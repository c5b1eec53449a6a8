#include "server/store/postgres/postgres_store.hpp"

#include "server/store/postgres/migrations.hpp"
#include "server/store/postgres/postgres_coordination.hpp"
#include "server/store/postgres/postgres_database.hpp"
#include "server/store/silent_store.hpp"

#include <random>

namespace driftlab::server {
namespace {

/// Sixteen hexadecimal digits that no other process has.
std::string random_word() {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::random_device device;
  std::uniform_int_distribution<std::size_t> digit(0, kDigits.size() - 1);
  std::string word(16, '0');
  for (char& letter : word) {
    letter = kDigits[digit(device)];
  }
  return word;
}

/// A connection by which triggers of the database know whose transaction they run in.
Result<std::unique_ptr<PostgresConnection>> open_marked(const std::string& uri, const std::string& application,
                                                        const std::string& origin) {
  auto connection = PostgresConnection::open(uri, application);
  if (connection) {
    if (auto marked = (*connection)->execute("SET driftlab.origin = '" + origin + "'"); !marked) {
      return fail(marked.error());
    }
  }
  return connection;
}

/// A connection to a database that is still one with which this program may work: who was cut off while that changed
/// writes nothing more.
Result<std::unique_ptr<PostgresConnection>> open_of_schema(const ConnectionPool::Opener& open,
                                                           const std::vector<Migration>& migrations) {
  auto connection = open();
  if (connection) {
    if (const auto schema = require_schema(**connection, migrations); !schema) {
      return schema.error().code == ErrorCode::Conflict
                 ? fail(silent_store(schema.error().message, schema.error().fields))
                 : fail(schema.error());
    }
  }
  return connection;
}

}  // namespace

PostgresStore::PostgresStore(std::unique_ptr<PostgresDatabase> postgres, PostgresFacts facts,
                             std::vector<Migration> migrations, std::unique_ptr<DaemonLock> lock,
                             std::unique_ptr<Coordination> coordination, std::uint64_t jitter_seed,
                             AuditListener audited)
    : SqlStore(std::move(postgres), jitter_seed, std::move(audited)),
      clock_(static_cast<const PostgresDatabase&>(database()).clock()),
      facts_(std::move(facts)),
      migrations_(std::move(migrations)),
      database_schema_(facts_.schema),
      lock_(std::move(lock)),
      coordination_(std::move(coordination)) {}

Status PostgresStore::ping() {
  if (lock_) {
    if (Status held = lock_->hold(); !held) {
      return held;
    }
  }
  const auto schema =
      database().read([this](Connection& connection) { return require_schema(connection, migrations_); });
  if (schema) {
    database_schema_ = *schema;
    return {};
  }
  if (schema.error().code == ErrorCode::Conflict) {
    static_cast<PostgresDatabase&>(database()).retire_connections();
  }
  return fail(schema.error());
}

std::string PostgresStore::newer_schema() const {
  return told_newer_schema(database_schema_, static_cast<int>(migrations_.size()));
}

Result<std::unique_ptr<PostgresStore>> open_postgres_store(const std::string& uri, PostgresOptions options) {
  const std::string origin = random_word();
  const ConnectionPool::Opener open = [uri, application = options.application, origin] {
    return open_marked(uri, application, origin);
  };
  std::unique_ptr<DaemonLock> lock;
  if (options.lock) {
    lock = std::make_unique<DaemonLock>(open, *options.lock);
    if (Status held = lock->hold_at_start(); !held) {
      return fail(held.error());
    }
  }
  PostgresFacts facts;
  std::vector<Migration> migrations = options.migrations ? *options.migrations : embedded_postgres_migrations();
  {
    const auto connection = open();
    if (!connection) {
      return fail(connection.error());
    }
    const auto migrated = migrate(**connection, migrations,
                                  lock == nullptr || lock->came_first() || options.lock == DaemonLock::Kind::Alone);
    if (!migrated) {
      return fail(migrated.error());
    }
    const auto identity = (*connection)->query_text("SELECT word FROM store_identity");
    const auto filled_from = (*connection)->query_text("SELECT filled_from FROM store_identity");
    if (!identity || !filled_from) {
      return fail(identity ? filled_from.error() : identity.error());
    }
    const int version = (*connection)->server_version();
    facts = {std::to_string(version / 10000) + "." + std::to_string(version % 10000),
             (*connection)->name(),
             migrated->from,
             migrated->to,
             identity->value_or(""),
             filled_from->value_or("")};
  }
  const ConnectionPool::Opener open_checked = [open, migrations] { return open_of_schema(open, migrations); };
  std::unique_ptr<Coordination> coordination;
  if (options.lock == DaemonLock::Kind::Together) {
    coordination = std::make_unique<PostgresCoordination>(open_checked, *lock, origin);
  }
  const std::uint64_t seed = options.jitter_seed ? *options.jitter_seed : std::random_device{}();
  auto database = std::make_unique<PostgresDatabase>(open_checked, options.connections, options.clock, seed);
  return std::make_unique<PostgresStore>(std::move(database), std::move(facts), std::move(migrations), std::move(lock),
                                         std::move(coordination), seed, std::move(options.audited));
}

}  // namespace driftlab::server
