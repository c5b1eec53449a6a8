#include "server/store/sql/access_tables.hpp"

namespace driftlab::server::tables {
namespace {

#define DRIFTLAB_AUDIT_COLUMNS "sequence, at, actor, action, object, request_id, address, detail, previous, digest"

constexpr std::string_view kLast = "SELECT " DRIFTLAB_AUDIT_COLUMNS " FROM audit ORDER BY sequence DESC LIMIT 1";
constexpr std::string_view kAppend =
    "INSERT INTO audit (" DRIFTLAB_AUDIT_COLUMNS ") VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?)";
constexpr std::string_view kAfter =
    "SELECT " DRIFTLAB_AUDIT_COLUMNS " FROM audit WHERE sequence > ? ORDER BY sequence LIMIT ?";
constexpr std::string_view kBefore =
    "SELECT " DRIFTLAB_AUDIT_COLUMNS " FROM audit WHERE sequence < ? ORDER BY sequence DESC LIMIT ?";
constexpr std::string_view kWhole = "SELECT " DRIFTLAB_AUDIT_COLUMNS " FROM audit ORDER BY sequence";
constexpr std::string_view kOwn = "INSERT INTO owners (object_id, token_id) VALUES (?, ?) ON CONFLICT DO NOTHING";
constexpr std::string_view kIsOwner = "SELECT 1 FROM owners WHERE object_id = ? AND token_id = ?";
constexpr std::string_view kNamesOther =
    "SELECT 1 FROM job_devices JOIN devices ON devices.id = job_devices.device_id "
    "WHERE job_id = ? AND devices.name NOT IN (SELECT value FROM json_each(?))";

AuditRow read_row(const Statement& row) {
  AuditRow read;
  read.sequence = row.integer(0);
  read.at = row.integer(1);
  read.actor = row.text(2);
  read.action = row.text(3);
  read.object = row.text(4);
  read.request_id = row.text(5);
  read.address = row.text(6);
  read.detail = row.text(7);
  read.previous = row.text(8);
  read.digest = row.text(9);
  return read;
}

std::string actor_of(const Caller& caller) {
  const Principal& who = caller.principal;
  return who.token.empty() ? (who.name.empty() ? "local" : who.name) : who.token;
}

}  // namespace

Result<AuditRow> append_audit(Connection& connection, const Caller& caller, const AuditEntry& entry, UtcMicros now) {
  Statement statement = connection.prepare(kLast);
  const Result<std::optional<AuditRow>> found = first_row(statement, read_row);
  if (!found) {
    return fail(found.error());
  }
  const std::optional<AuditRow>& last = *found;
  AuditRow row;
  row.sequence = last ? last->sequence + 1 : 1;
  row.previous = last ? last->digest : AuditWalk().verdict().head;
  row.at = now;
  row.actor = actor_of(caller);
  row.action = entry.action;
  row.object = entry.object;
  row.request_id = caller.request_id;
  row.address = caller.address;
  row.detail = entry.detail;
  row.digest = digest_of(row);
  Status appended = connection.prepare(kAppend)
                        .bind(row.sequence, row.at, row.actor, row.action, row.object, row.request_id, row.address,
                              row.detail, row.previous, row.digest)
                        .run();
  if (!appended) {
    return fail(appended.error());
  }
  return row;
}

Result<std::vector<AuditRow>> audit(Connection& connection, std::int64_t after, int limit, bool newest_first) {
  Statement statement = connection.prepare(newest_first ? kBefore : kAfter);
  statement.bind(newest_first && after == 0 ? std::numeric_limits<std::int64_t>::max() : after, limit);
  return all_rows(statement, read_row);
}

Result<AuditVerdict> verify_audit(Connection& connection) {
  Statement statement = connection.prepare(kWhole);
  AuditWalk walk;
  while (true) {
    const Result<bool> row = statement.step();
    if (!row) {
      return fail(row.error());
    }
    if (!*row || !walk.take(read_row(statement))) {
      return walk.verdict();
    }
  }
}

Status add_owner(Connection& connection, std::string_view object, const Caller& caller) {
  return caller.principal.token.empty() ? Status{}
                                        : connection.prepare(kOwn).bind(object, caller.principal.token).run();
}

Result<bool> is_owner(Connection& connection, std::string_view object, std::string_view token) {
  return connection.prepare(kIsOwner).bind(object, token).step();
}

Result<bool> is_job_within(Connection& connection, std::string_view job, std::string_view devices_json) {
  return connection.prepare(kNamesOther).bind(job, devices_json).step().map([](bool other) { return !other; });
}

Result<bool> sees_job(Connection& connection, std::string_view job, const Visibility& visible) {
  const std::string sql = "SELECT 1 FROM jobs WHERE id = ? AND " + std::string(kVisibleJob);
  return connection.prepare(sql).bind(job, visible.token, visible.devices_json).step();
}

}  // namespace driftlab::server::tables
