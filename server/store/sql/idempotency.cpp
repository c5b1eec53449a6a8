#include "server/store/sql/tables.hpp"

namespace driftlab::server::tables {
namespace {

constexpr UtcMicros kLifetimeMicros = 24LL * 3600 * 1'000'000;

constexpr std::string_view kSelect =
    "SELECT key, method, target, body_sha256, status, headers_json, body, created_at, seal FROM idempotent_replies "
    "WHERE key = ? AND created_at > ?";
/// ?8 now, ?9 the time before which a reply is forgotten, ?10 its seal. A younger reply stays: the first answer is the
/// answer.
constexpr std::string_view kRemember =
    "INSERT INTO idempotent_replies (key, method, target, body_sha256, status, headers_json, body, created_at, seal) "
    "VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?10) ON CONFLICT (key) DO UPDATE SET method = excluded.method, "
    "target = excluded.target, body_sha256 = excluded.body_sha256, status = excluded.status, "
    "headers_json = excluded.headers_json, body = excluded.body, created_at = excluded.created_at, seal = "
    "excluded.seal "
    "WHERE idempotent_replies.created_at <= ?9";
constexpr std::string_view kForget = "DELETE FROM idempotent_replies WHERE created_at <= ?";

Result<IdempotentReply> read_reply(const Statement& row) {
  IdempotentReply reply;
  reply.key = row.text(0);
  reply.method = row.text(1);
  reply.target = row.text(2);
  reply.body_sha256 = row.text(3);
  reply.status = static_cast<int>(row.integer(4));
  reply.headers_json = row.text(5);
  reply.body = row.text(6);
  reply.created_at = row.integer(7);
  return sound_row("idempotent_replies", row.text(0), std::move(reply), row.text(8));
}

}  // namespace

Result<std::optional<IdempotentReply>> idempotent_reply(Connection& connection, std::string_view key, UtcMicros now) {
  Statement statement = connection.prepare(kSelect);
  statement.bind(key, now - kLifetimeMicros);
  return first_row(statement, read_reply);
}

Status remember_reply(Connection& connection, const IdempotentReply& reply, UtcMicros now) {
  return connection.prepare(kRemember)
      .bind(reply.key, reply.method, reply.target, reply.body_sha256, reply.status, reply.headers_json, reply.body, now,
            now - kLifetimeMicros, seal_of(reply))
      .run();
}

Result<int> forget_old_replies(Connection& connection, UtcMicros now) {
  if (Status forgotten = connection.prepare(kForget).bind(now - kLifetimeMicros).run(); !forgotten) {
    return fail(forgotten.error());
  }
  return connection.changes();
}

}  // namespace driftlab::server::tables
