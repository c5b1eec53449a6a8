#include "server/store/sql/access_tables.hpp"
#include "server/store/sql/seals.hpp"

#include <nlohmann/json.hpp>

namespace driftlab::server::tables {
namespace {

/// The sealed columns first (seals.cpp).
#define DRIFTLAB_TOKEN_COLUMNS \
  "id, name, scope, devices_json, secret_sha256, created_at, expires_at, revoked_at, rotated_at, last_used_at"
constexpr int kSealed = 8;

constexpr std::string_view kAll = "SELECT " DRIFTLAB_TOKEN_COLUMNS ", seal FROM tokens ORDER BY created_at, id";
constexpr std::string_view kById = "SELECT " DRIFTLAB_TOKEN_COLUMNS ", seal FROM tokens WHERE id = ?";
constexpr std::string_view kInsert =
    "INSERT INTO tokens (" DRIFTLAB_TOKEN_COLUMNS ") VALUES (?, ?, ?, ?, ?, ?, ?, NULL, NULL, NULL)";
constexpr std::string_view kRevoke =
    "UPDATE tokens SET revoked_at = ?2, seal = '' WHERE id = ?1 AND revoked_at IS NULL";
constexpr std::string_view kRotate = "UPDATE tokens SET secret_sha256 = ?2, rotated_at = ?3, seal = '' WHERE id = ?1";
constexpr std::string_view kUse =
    "UPDATE tokens SET last_used_at = CASE WHEN coalesce(last_used_at, 0) < ?2 THEN ?2 ELSE last_used_at END WHERE id "
    "= ?1";
constexpr std::string_view kSessions =
    "SELECT secret_sha256, token_id, created_at, expires_at FROM sessions WHERE expires_at > ?";
constexpr std::string_view kOpen =
    "INSERT INTO sessions (secret_sha256, token_id, created_at, expires_at) VALUES (?, ?, ?, ?)";
constexpr std::string_view kForget = "DELETE FROM sessions WHERE expires_at <= ?";
constexpr std::string_view kForgetOldest =
    "DELETE FROM sessions WHERE token_id = ?1 AND secret_sha256 NOT IN "
    "(SELECT secret_sha256 FROM sessions WHERE token_id = ?1 ORDER BY created_at DESC, secret_sha256 LIMIT 50)";
constexpr std::string_view kEndAll = "DELETE FROM sessions WHERE token_id = ?";
constexpr std::string_view kClose = "DELETE FROM sessions WHERE secret_sha256 = ? RETURNING token_id";

std::optional<std::string> written(const std::optional<std::vector<std::string>>& devices) {
  return devices ? std::optional(nlohmann::json(*devices).dump()) : std::nullopt;
}

std::optional<std::vector<std::string>> read_devices(const std::string& text) {
  const auto list = nlohmann::json::parse(text, nullptr, false);
  return list.is_array() ? std::optional(list.get<std::vector<std::string>>()) : std::nullopt;
}

Token read_token(const Statement& row) {
  Token token;
  token.id = row.text(0);
  token.name = row.text(1);
  token.scope = parse_scope(row.text(2)).value_or(Scope::Read);
  token.devices = read_devices(row.text(3));
  token.secret_sha256 = row.text(4);
  token.created_at = row.integer(5);
  token.expires_at = row.optional_integer(6);
  token.revoked_at = row.optional_integer(7);
  token.rotated_at = row.optional_integer(8);
  token.last_used_at = row.optional_integer(9);
  std::vector<std::string> sealed;
  for (int column = 0; column < kSealed; ++column) {
    sealed.push_back(row.text(column));
  }
  token.is_damaged = !seal_fits(row.text(10), seal_of_texts({sealed.begin(), sealed.end()}));
  return token;
}

Session read_session(const Statement& row) { return {row.text(0), row.text(1), row.integer(2), row.integer(3)}; }

std::string read_text(const Statement& row) { return row.text(0); }

Result<Token> token_of(Connection& connection, std::string_view id) {
  Statement statement = connection.prepare(kById);
  statement.bind(id);
  return one_row(statement, read_token,
                 {ErrorCode::NotFound, "There is no token \"" + std::string(id) + "\".", {{"token", std::string(id)}}});
}

}  // namespace

Result<std::vector<Token>> tokens(Connection& connection) {
  Statement statement = connection.prepare(kAll);
  return all_rows(statement, read_token);
}

Result<Token> add_token(Connection& connection, const Token& token, UtcMicros now) {
  Token made = token;
  made.created_at = now;
  Statement insert = connection.prepare(kInsert);
  insert.bind(made.id, made.name, name_of(made.scope), written(made.devices), made.secret_sha256, made.created_at,
              made.expires_at);
  if (Status inserted = run_and_seal(connection, "tokens", insert); !inserted) {
    return fail(inserted.error());
  }
  return made;
}

Result<RevokedToken> revoke_token(Connection& connection, std::string_view id, UtcMicros now) {
  const Result<Token> found = token_of(connection, id);
  if (!found) {
    return fail(found.error());
  }
  const bool changed = !found->revoked_at;
  Statement revoke = connection.prepare(kRevoke);
  revoke.bind(id, now);
  if (Status revoked = run_and_seal(connection, "tokens", revoke); !revoked) {
    return fail(revoked.error());
  }
  if (Status ended = connection.prepare(kEndAll).bind(id).run(); !ended) {
    return fail(ended.error());
  }
  return token_of(connection, id).map([&](Token token) { return RevokedToken{std::move(token), changed}; });
}

Result<Token> rotate_token(Connection& connection, std::string_view id, std::string_view secret_sha256, UtcMicros now) {
  const Result<Token> found = token_of(connection, id);
  if (!found) {
    return fail(found.error());
  }
  if (found->revoked_at) {
    return fail(ErrorCode::Conflict, "The token " + found->id + " is revoked; make another one.",
                {{"token", found->id}});
  }
  if (found->is_damaged) {
    return fail(damaged_in("tokens", id));
  }
  Statement rotate = connection.prepare(kRotate);
  rotate.bind(id, secret_sha256, now);
  if (Status rotated = run_and_seal(connection, "tokens", rotate); !rotated) {
    return fail(rotated.error());
  }
  if (Status ended = connection.prepare(kEndAll).bind(id).run(); !ended) {
    return fail(ended.error());
  }
  return token_of(connection, id);
}

Status note_use(Connection& connection, const std::vector<std::pair<std::string, UtcMicros>>& uses) {
  for (const auto& [id, at] : uses) {
    if (Status noted = connection.prepare(kUse).bind(id, at).run(); !noted) {
      return noted;
    }
  }
  return {};
}

Result<std::vector<Session>> sessions(Connection& connection, UtcMicros now) {
  Statement statement = connection.prepare(kSessions);
  statement.bind(now);
  return all_rows(statement, read_session);
}

Status open_session(Connection& connection, const Session& session, UtcMicros now) {
  if (Status forgotten = connection.prepare(kForget).bind(now).run(); !forgotten) {
    return forgotten;
  }
  Status opened = connection.prepare(kOpen)
                      .bind(session.secret_sha256, session.token, session.created_at, session.expires_at)
                      .run();
  if (!opened) {
    return opened;
  }
  return connection.prepare(kForgetOldest).bind(session.token).run();
}

Result<std::string> close_session(Connection& connection, std::string_view secret_sha256) {
  Statement statement = connection.prepare(kClose);
  statement.bind(secret_sha256);
  const auto closed = first_row(statement, read_text);
  if (!closed) {
    return fail(closed.error());
  }
  return closed->value_or("");
}

}  // namespace driftlab::server::tables
