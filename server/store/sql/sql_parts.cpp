#include "server/store/sql/sql_parts.hpp"

#include "server/store/sql/job_rows.hpp"

#include <algorithm>

namespace driftlab::server {
namespace {

using tables::all_rows;
using tables::first_row;

constexpr std::string_view kHeld =
    "SELECT cancel_requested FROM jobs WHERE id = ?1 AND attempt = ?2 AND state = 'running'";
constexpr std::string_view kAsBefore =
    "SELECT CASE WHEN count(*) = ?2 AND min(program) = ?3 AND max(program) = ?3 THEN 1 ELSE 0 END FROM job_parts WHERE "
    "job_id = ?1";
constexpr std::string_view kForget = "DELETE FROM job_parts WHERE job_id = ?1";
/// Claims of one division are no claims of the next: they begin at ?4.
constexpr std::string_view kDivide =
    "WITH RECURSIVE numbers (n) AS (SELECT CAST(0 AS BIGINT) UNION ALL SELECT n + 1 FROM numbers WHERE n + 1 < "
    "CAST(?2 AS BIGINT)) INSERT INTO job_parts (job_id, number, program, state, claim) SELECT ?1, n, ?3, 'open', ?4 "
    "FROM numbers";
constexpr std::string_view kToHelp =
    "SELECT " DRIFTLAB_JOB_COLUMNS
    " FROM jobs WHERE state = 'running' AND cancel_requested = 0 AND " DRIFTLAB_CAN_RUN(
        "?1") " AND EXISTS (SELECT 1 FROM job_parts WHERE job_parts.job_id = jobs.id AND job_parts.state = 'open' AND "
              "program = ?2) ORDER BY priority, id LIMIT 1";
/// ?1 the job, ?2 now, ?3 lease end, ?4 whether it is its own worker who asks.
#define DRIFTLAB_CLAIM_PART(LOCK)                                                                                    \
  "UPDATE job_parts SET state = 'running', claim = claim + 1, lease_expires_at = ?3 WHERE job_id = ?1 AND number = " \
  "(SELECT number FROM job_parts WHERE job_id = ?1 AND (state = 'open' OR (CAST(?4 AS BIGINT) = 1 AND state = "      \
  "'running' AND lease_expires_at <= ?2)) ORDER BY number LIMIT 1" LOCK ") RETURNING number, claim"
constexpr EngineTexts kClaim{DRIFTLAB_CLAIM_PART(""), DRIFTLAB_CLAIM_PART(" FOR UPDATE SKIP LOCKED")};
#define DRIFTLAB_OF_CLAIM                                                               \
  " WHERE job_id = ?1 AND number = ?2 AND claim = ?3 AND state = 'running' RETURNING (" \
  "SELECT cancel_requested FROM jobs WHERE id = ?1)"
constexpr std::string_view kRenew = "UPDATE job_parts SET lease_expires_at = ?4" DRIFTLAB_OF_CLAIM;
constexpr std::string_view kFinish =
    "UPDATE job_parts SET state = 'finished', lease_expires_at = NULL, result = ?4" DRIFTLAB_OF_CLAIM;
constexpr std::string_view kPutBack = "UPDATE job_parts SET state = 'open', lease_expires_at = NULL" DRIFTLAB_OF_CLAIM;
constexpr std::string_view kFinished =
    "SELECT number, result FROM job_parts WHERE job_id = ?1 AND number >= ?2 AND state = 'finished' ORDER BY number "
    "LIMIT ?3";
constexpr std::string_view kCountFinished = "SELECT count(*) FROM job_parts WHERE job_id = ?1 AND state = 'finished'";

struct NumberedResult {
  std::int64_t number = 0;
  std::string result;
};

NumberedResult read_result(const Statement& row) { return {row.integer(0), row.text(1)}; }

std::int64_t read_integer(const Statement& row) { return row.integer(0); }

/// Whether the update changed its row, and whether the job is to be cancelled.
Result<LeaseStatus> fenced_part(Statement& update) {
  return first_row(update, read_integer).map([](const std::optional<std::int64_t>& cancel) {
    return cancel ? LeaseStatus{true, *cancel != 0} : LeaseStatus{};
  });
}

}  // namespace

Result<LeaseStatus> SqlParts::divide(const Lease& lease, std::int64_t count, std::string_view program) {
  return database_.write(WriteKind::Serial, [&](Connection& c) -> Result<LeaseStatus> {
    Statement held = c.prepare(kHeld);
    held.bind(lease.job_id, lease.attempt);
    const auto cancel = first_row(held, read_integer);
    if (!cancel || !*cancel) {
      return cancel ? Result<LeaseStatus>(LeaseStatus{}) : fail(cancel.error());
    }
    Statement before = c.prepare(kAsBefore);
    before.bind(lease.job_id, count, program);
    const auto as_before = first_row(before, read_integer);
    if (!as_before) {
      return fail(as_before.error());
    }
    if (as_before->value_or(0) == 0) {
      constexpr std::int64_t kMostClaims = 1'000'000;
      Status divided = c.prepare(kForget).bind(lease.job_id).run();
      if (divided) {
        divided = c.prepare(kDivide).bind(lease.job_id, count, program, lease.attempt * kMostClaims).run();
      }
      if (!divided) {
        return fail(divided.error());
      }
    }
    return LeaseStatus{true, **cancel != 0};
  });
}

Result<std::optional<Job>> SqlParts::job_to_help(const std::vector<KnownKind>& known, std::string_view program) {
  return database_.read([&](Connection& c) {
    Statement statement = c.prepare(kToHelp);
    statement.bind(tables::can_run(known), program);
    return first_row(statement, tables::read_job);
  });
}

Result<std::optional<PartClaim>> SqlParts::claim_part(std::string_view job_id, bool own, std::int64_t lease_micros) {
  return database_.write(WriteKind::Fenced, [&](Connection& c) -> Result<std::optional<PartClaim>> {
    const UtcMicros now = database_.now(c);
    Statement update = c.prepare(kClaim);
    update.bind(job_id, now, now + lease_micros, own ? 1 : 0);
    const Result<bool> row = update.step();
    if (!row) {
      return fail(row.error());
    }
    return *row ? std::optional(PartClaim{std::string(job_id), update.integer(0), update.integer(1)}) : std::nullopt;
  });
}

Result<LeaseStatus> SqlParts::renew_part(const PartClaim& claim, std::int64_t lease_micros) {
  return database_.write(WriteKind::Fenced, [&](Connection& c) {
    Statement update = c.prepare(kRenew);
    update.bind(claim.job_id, claim.number, claim.claim, database_.now(c) + lease_micros);
    return fenced_part(update);
  });
}

Result<LeaseStatus> SqlParts::finish_part(const PartClaim& claim, std::string_view result) {
  return database_.write(WriteKind::Fenced, [&](Connection& c) {
    Statement update = c.prepare(kFinish);
    update.bind(claim.job_id, claim.number, claim.claim, result);
    return fenced_part(update);
  });
}

Result<LeaseStatus> SqlParts::put_back_part(const PartClaim& claim) {
  return database_.write(WriteKind::Fenced, [&](Connection& c) {
    Statement update = c.prepare(kPutBack);
    update.bind(claim.job_id, claim.number, claim.claim);
    return fenced_part(update);
  });
}

Result<std::vector<std::string>> SqlParts::finished_parts(std::string_view job_id, std::int64_t first, int limit) {
  return database_.read([&](Connection& c) {
    Statement statement = c.prepare(kFinished);
    statement.bind(job_id, first, limit);
    return all_rows(statement, read_result).map([&](std::vector<NumberedResult> rows) {
      std::vector<std::string> results;
      for (NumberedResult& row : rows) {
        if (row.number != first + std::ssize(results)) {
          break;
        }
        results.push_back(std::move(row.result));
      }
      return results;
    });
  });
}

Result<std::int64_t> SqlParts::count_finished_parts(std::string_view job_id) {
  return database_.read([&](Connection& c) {
    Statement statement = c.prepare(kCountFinished);
    statement.bind(job_id);
    return first_row(statement, read_integer).map([](const std::optional<std::int64_t>& count) {
      return count.value_or(0);
    });
  });
}

}  // namespace driftlab::server
