#include "server/store/postgres/postgres_store.hpp"

#include "server/store/postgres/migrations.hpp"
#include "server/store/postgres/postgres_database.hpp"

#include <random>

namespace driftlab::server {

PostgresStore::PostgresStore(std::unique_ptr<Database> database, PostgresFacts facts, std::vector<Migration> migrations,
                             std::unique_ptr<DaemonLock> lock, std::uint64_t jitter_seed, AuditListener audited)
    : SqlStore(std::move(database), jitter_seed, std::move(audited)),
      facts_(std::move(facts)),
      migrations_(std::move(migrations)),
      lock_(std::move(lock)) {}

Status PostgresStore::ping() {
  if (lock_) {
    if (Status held = lock_->hold(); !held) {
      return held;
    }
  }
  return database().read([this](Connection& connection) { return require_schema(connection, migrations_); });
}

Result<std::unique_ptr<PostgresStore>> open_postgres_store(const std::string& uri, PostgresOptions options) {
  const ConnectionPool::Opener open = [uri, application = options.application] {
    return PostgresConnection::open(uri, application);
  };
  std::unique_ptr<DaemonLock> lock;
  if (options.exclusive) {
    lock = std::make_unique<DaemonLock>(open);
    if (Status held = lock->hold_at_start(); !held) {
      return fail(held.error());
    }
  }
  PostgresFacts facts;
  std::vector<Migration> migrations =
      options.migrations ? std::move(*options.migrations) : embedded_postgres_migrations();
  {
    const auto connection = open();
    if (!connection) {
      return fail(connection.error());
    }
    const auto migrated = migrate(**connection, migrations);
    if (!migrated) {
      return fail(migrated.error());
    }
    const auto identity = (*connection)->query_text("SELECT word FROM store_identity");
    if (!identity) {
      return fail(identity.error());
    }
    const int version = (*connection)->server_version();
    facts = {std::to_string(version / 10000) + "." + std::to_string(version % 10000), (*connection)->name(),
             migrated->from, migrated->to, identity->value_or("")};
  }
  const std::uint64_t seed = options.jitter_seed ? *options.jitter_seed : std::random_device{}();
  auto database = std::make_unique<PostgresDatabase>(open, options.connections, options.clock, seed);
  return std::make_unique<PostgresStore>(std::move(database), std::move(facts), std::move(migrations), std::move(lock),
                                         seed, std::move(options.audited));
}

}  // namespace driftlab::server
