#pragma once
/// What the access store and the audited methods of the store do inside a transaction (see tables.hpp).
#include "server/store/access_store.hpp"
#include "server/store/sql/tables.hpp"

namespace driftlab::server::tables {

// ---- tokens and sessions
[[nodiscard]] Result<std::vector<Token>> tokens(Connection& connection);
[[nodiscard]] Result<Token> add_token(Connection& connection, const Token& token, UtcMicros now);
/// The token, and whether it was live until now.
struct RevokedToken {
  Token token;
  bool changed = false;
};
[[nodiscard]] Result<RevokedToken> revoke_token(Connection& connection, std::string_view id, UtcMicros now);
[[nodiscard]] Result<Token> rotate_token(Connection& connection, std::string_view id, std::string_view secret_sha256,
                                         UtcMicros now);
[[nodiscard]] Status note_use(Connection& connection, const std::vector<std::pair<std::string, UtcMicros>>& uses);
[[nodiscard]] Result<std::vector<Session>> sessions(Connection& connection, UtcMicros now);
[[nodiscard]] Status open_session(Connection& connection, const Session& session, UtcMicros now);
/// The id of the token whose session it was; empty where there was none.
[[nodiscard]] Result<std::string> close_session(Connection& connection, std::string_view secret_sha256);

// ---- audit log
/// What a change did, to be written with who did it.
struct AuditEntry {
  std::string action;
  std::string object;
  std::string detail;
};
/// Appends a row for the caller. The row as it stands in the chain.
[[nodiscard]] Result<AuditRow> append_audit(Connection& connection, const Caller& caller, const AuditEntry& entry,
                                            UtcMicros now);
[[nodiscard]] Result<std::vector<AuditRow>> audit(Connection& connection, std::int64_t after, int limit,
                                                  bool newest_first);
[[nodiscard]] Result<AuditVerdict> verify_audit(Connection& connection);

// ---- who asked for an object
/// Nothing happens for a caller without a token.
[[nodiscard]] Status add_owner(Connection& connection, std::string_view object, const Caller& caller);
[[nodiscard]] Result<bool> is_owner(Connection& connection, std::string_view object, std::string_view token);
[[nodiscard]] Result<bool> sees_job(Connection& connection, std::string_view job, const Visibility& visible);
/// Whether the job names no device but these.
[[nodiscard]] Result<bool> is_job_within(Connection& connection, std::string_view job, std::string_view devices_json);

}  // namespace driftlab::server::tables
