#include "server/store/sql/sql_access.hpp"

namespace driftlab::server {
namespace {

std::string detail_of(const Token& token) {
  std::string detail = "scope " + std::string(name_of(token.scope)) + ", name " + token.name;
  for (const std::string& device : token.devices.value_or(std::vector<std::string>{})) {
    detail += ", device " + device;
  }
  return detail;
}

}  // namespace

Result<std::vector<Token>> SqlAccess::tokens() {
  auto all = database_.read([](Connection& c) { return tables::tokens(c); });
  for (const Token& token : all ? *all : std::vector<Token>{}) {
    if (token.is_damaged) {
      database_.tell_damage(damaged_in("tokens", token.id));
    }
  }
  return all;
}

Result<Token> SqlAccess::add_token(const Token& token) {
  return audited_.write(
      [&](Connection& c) { return tables::add_token(c, token, database_.now(c)); },
      [](const Token& made) { return std::optional(tables::AuditEntry{"token.create", made.id, detail_of(made)}); });
}

Result<Token> SqlAccess::revoke_token(std::string_view id) {
  return audited_
      .write([&](Connection& c) { return tables::revoke_token(c, id, database_.now(c)); },
             [](const tables::RevokedToken& revoked) {
               return revoked.changed ? std::optional(tables::AuditEntry{"token.revoke", revoked.token.id, ""})
                                      : std::nullopt;
             })
      .map([](tables::RevokedToken revoked) { return std::move(revoked.token); });
}

Result<Token> SqlAccess::rotate_token(std::string_view id, std::string_view secret_sha256) {
  return audited_.write(
      [&](Connection& c) { return tables::rotate_token(c, id, secret_sha256, database_.now(c)); },
      [](const Token& token) { return std::optional(tables::AuditEntry{"token.rotate", token.id, ""}); });
}

Status SqlAccess::note_use(const std::vector<std::pair<std::string, UtcMicros>>& uses) {
  return database_.write(WriteKind::Serial, [&](Connection& c) { return tables::note_use(c, uses); });
}

Result<std::vector<Session>> SqlAccess::sessions() {
  return database_.read([&](Connection& c) { return tables::sessions(c, database_.now(c)); });
}

Status SqlAccess::open_session(const Session& session) {
  const auto opened = audited_.write(
      [&](Connection& c) {
        Status status = tables::open_session(c, session, database_.now(c));
        return status ? Result<std::string>(session.token) : fail(status.error());
      },
      [](const std::string& token) { return std::optional(tables::AuditEntry{"session.open", token, ""}); });
  return opened ? Status{} : fail(opened.error());
}

Status SqlAccess::close_session(std::string_view secret_sha256) {
  const auto closed = audited_.write(
      [&](Connection& c) { return tables::close_session(c, secret_sha256); },
      [](const std::string& token) {
        return token.empty() ? std::nullopt : std::optional(tables::AuditEntry{"session.close", token, ""});
      });
  return closed ? Status{} : fail(closed.error());
}

Status SqlAccess::note_state(const std::string& action, const std::string& object, const std::string& detail) {
  Caller self;
  self.principal.name = "daemon";
  const ActingFor acting(self);
  const auto noted =
      audited_.write([](Connection& /*connection*/) { return Result<bool>(true); },
                     [&](bool /*noted*/) { return std::optional(tables::AuditEntry{action, object, detail}); });
  return noted ? Status{} : fail(noted.error());
}

Result<std::vector<AuditRow>> SqlAccess::audit(std::int64_t after, int limit, bool newest_first) {
  return database_.read([&](Connection& c) { return tables::audit(c, after, limit, newest_first); });
}

Result<AuditVerdict> SqlAccess::verify_audit() {
  return database_.read([](Connection& c) { return tables::verify_audit(c); });
}

}  // namespace driftlab::server
