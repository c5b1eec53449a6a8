/// The moves of server/jobs/README.md. Every write of a worker names the attempt it belongs to: where another attempt
/// has begun, or the job has ended, it changes nothing and the worker learns that its lease is lost.
#include "server/store/crash_point.hpp"
#include "server/store/retry_policy.hpp"
#include "server/store/sql/job_rows.hpp"

#include <algorithm>
#include <cmath>

namespace driftlab::server::tables {
namespace {

/// ?1 now, ?2 lease end, ?3 longest pause, ?4 ageing step, ?5 jobs of one token that run at once, ?6 what the process
/// can run, as `can_run` writes it. A job without
/// failures has nothing to wait for, and nobody has to wait longer than the longest pause: a run_at beyond it was
/// written before the clock went back.
///
/// Jobs that the same tokens asked for with one priority stand in one line, and its first job goes before all others of
/// it whatever the time is: so only the heads of the lines are compared, however many wait. `beside`: how many jobs run
/// of the token that asked for those of a line; of several, of the one with the fewest; 0 where nobody is known. Each
/// puts the token's other jobs one priority back, so that a thousand of one do not stand before the first of another.
#define DRIFTLAB_LINES                                                                                              \
  "WITH RECURSIVE running AS (SELECT token_id, count(*) AS jobs FROM owners JOIN jobs AS busy ON busy.id = "        \
  "owners.object_id WHERE busy.state = 'running' GROUP BY token_id), "                                              \
  "askers (who) AS (SELECT min(asked_by) FROM jobs WHERE state = 'queued' UNION ALL SELECT (SELECT min(asked_by) "  \
  "FROM jobs WHERE state = 'queued' AND asked_by > askers.who) FROM askers WHERE who IS NOT NULL), "                \
  "besides (who, beside) AS MATERIALIZED (SELECT who, coalesce((SELECT min(coalesce(running.jobs, 0)) FROM owners " \
  "LEFT JOIN "                                                                                                      \
  "running ON running.token_id = owners.token_id WHERE owners.object_id = (SELECT id FROM jobs WHERE state = "      \
  "'queued' AND asked_by = who ORDER BY priority, run_at, id LIMIT 1)), 0) FROM askers WHERE who IS NOT NULL), "    \
  "ranks (rank) AS (VALUES (0), (1), (2), (3), (4), (5), (6), (7), (8), (9)) "
#define DRIFTLAB_HEAD                                                                                          \
  "FROM jobs WHERE state = 'queued' AND asked_by = who AND priority = rank AND (run_at <= ?1 OR failures = 0 " \
  "OR run_at > ?1 + ?3) AND " DRIFTLAB_CAN_RUN("?6") " ORDER BY run_at, id LIMIT "
#define DRIFTLAB_BESIDE "(SELECT beside FROM besides WHERE who = jobs.asked_by)"
#define DRIFTLAB_BEST(LARGER) \
  " ORDER BY priority + " DRIFTLAB_BESIDE " - " LARGER "(0, ?1 - run_at) / ?4, run_at, id LIMIT 1"
#define DRIFTLAB_CLAIM(NEXT)                                                                                       \
  "UPDATE jobs SET state = 'running', attempt = attempt + 1, started_at = ?1, lease_expires_at = ?2, stage = '', " \
  "progress = 0 WHERE id = (" NEXT ") RETURNING " DRIFTLAB_JOB_COLUMNS
/// Where several claim at a time each passes over what another one is about to take: up to 64 at the head of a line.
constexpr EngineTexts kClaim{
    DRIFTLAB_CLAIM(DRIFTLAB_LINES "SELECT id FROM jobs WHERE id IN (SELECT (SELECT id " DRIFTLAB_HEAD
                                  "1) FROM besides CROSS JOIN ranks WHERE beside < ?5)" DRIFTLAB_BEST("max")),
    DRIFTLAB_CLAIM(
        DRIFTLAB_LINES
        "SELECT id FROM jobs WHERE state = 'queued' AND id = ANY (ARRAY (SELECT head.id FROM besides CROSS JOIN "
        "ranks CROSS JOIN LATERAL (SELECT id " DRIFTLAB_HEAD
        "64) AS head WHERE beside < ?5))" DRIFTLAB_BEST("greatest") " FOR UPDATE OF jobs SKIP LOCKED")};
constexpr std::string_view kRenew =
    "UPDATE jobs SET lease_expires_at = ?3 WHERE id = ?1 AND attempt = ?2 AND state = 'running' "
    "RETURNING cancel_requested";
constexpr std::string_view kProgress =
    "UPDATE jobs SET stage = ?3, progress = CASE WHEN progress < ?4 THEN ?4 ELSE progress END WHERE id = ?1 AND "
    "attempt = ?2 AND state = 'running' "
    "RETURNING cancel_requested";
constexpr std::string_view kSucceed =
    "UPDATE jobs SET state = 'succeeded', finished_at = ?3, lease_expires_at = NULL, stage = '', progress = 1, "
    "problem_json = '' WHERE id = ?1 AND attempt = ?2 AND state = 'running' RETURNING cancel_requested";
constexpr std::string_view kHeld =
    "SELECT cancel_requested, failures, faults, max_failures, started_at FROM jobs "
    "WHERE id = ?1 AND attempt = ?2 AND state = 'running'";
constexpr std::string_view kRememberFailure =
    "INSERT INTO job_attempts (job_id, attempt, started_at, failed_at, fault_signal, problem_json, seal) "
    "VALUES (?, ?, ?, ?, ?, ?, ?)";
constexpr std::string_view kFailToEnd =
    "UPDATE jobs SET state = ?2, finished_at = ?3, lease_expires_at = NULL, failures = ?4, faults = ?5, "
    "problem_json = ?6 WHERE id = ?1";
constexpr std::string_view kFailToQueue =
    "UPDATE jobs SET state = 'queued', run_at = ?2, lease_expires_at = NULL, stage = '', progress = 0, failures = ?3, "
    "faults = ?4, problem_json = ?5 WHERE id = ?1";
constexpr std::string_view kCancel =
    "UPDATE jobs SET state = 'cancelled', cancel_requested = 1, finished_at = ?2, lease_expires_at = NULL WHERE id = "
    "?1";
constexpr std::string_view kAskToCancel = "UPDATE jobs SET cancel_requested = 1 WHERE id = ?1";
constexpr std::string_view kPutBack =
    "UPDATE jobs SET state = 'queued', lease_expires_at = NULL, stage = '', progress = 0 WHERE id = ?1";
constexpr std::string_view kExpired =
    "SELECT id, cancel_requested FROM jobs WHERE state = 'running' AND (CAST(?1 AS BIGINT) IS NULL OR lease_expires_at "
    "<= ?1) ORDER BY "
    "id";

struct HeldJob {
  bool cancel_requested = false;
  int failures = 0;
  int faults = 0;
  int max_failures = 0;
  UtcMicros started_at = 0;
};

HeldJob read_held(const Statement& row) {
  return {row.integer(0) != 0, static_cast<int>(row.integer(1)), static_cast<int>(row.integer(2)),
          static_cast<int>(row.integer(3)), row.integer(4)};
}

/// The job if the lease is still good; nothing else.
Result<HeldJob> held_job(Connection& connection, const Lease& lease) {
  Statement statement = connection.prepare(kHeld);
  statement.bind(lease.job_id, lease.attempt);
  return one_row(statement, read_held, {ErrorCode::NotFound, "The lease is lost.", {}});
}

/// What a worker is told that asked with a lost lease, or where the database did not answer.
Result<LeaseStatus> not_held(const Error& error) {
  return error.code == ErrorCode::NotFound ? Result<LeaseStatus>(LeaseStatus{}) : fail(error);
}

/// Runs a fenced update that returns cancel_requested.
Result<LeaseStatus> fenced(Statement& update) {
  const Result<bool> row = update.step();
  if (!row) {
    return fail(row.error());
  }
  return *row ? LeaseStatus{true, update.integer(0) != 0} : LeaseStatus{};
}

/// Ends a move: the new state goes into the history.
Result<LeaseStatus> moved(Connection& connection, Status change, const Lease& lease, bool cancel_requested,
                          UtcMicros now) {
  if (change) {
    change = add_event(connection, lease.job_id, "state", now);
  }
  if (!change) {
    return fail(change.error());
  }
  return LeaseStatus{true, cancel_requested};
}

/// running -> queued, or -> cancelled where that was asked for. Does not count as a failure.
Status put_back(Connection& connection, std::string_view job_id, bool cancel_requested, UtcMicros now) {
  const Status change = cancel_requested ? connection.prepare(kCancel).bind(job_id, now).run()
                                         : connection.prepare(kPutBack).bind(job_id).run();
  return change ? add_event(connection, job_id, "state", now) : change;
}

/// Where a failed attempt leads: a terminal state, or nothing for another try.
std::optional<JobState> end_after(const AttemptFailure& failure, const HeldJob& job, int failures, int faults) {
  if (!failure.retryable && !failure.fault_signal) {
    return JobState::Failed;
  }
  if (faults >= kMaxFaults || failures >= job.max_failures) {
    return JobState::Dead;
  }
  return job.cancel_requested ? std::optional(JobState::Cancelled) : std::nullopt;
}

}  // namespace

Result<std::optional<Job>> claim(Connection& connection, std::int64_t lease_micros, std::int64_t running_per_token,
                                 const std::vector<KnownKind>& known, UtcMicros now) {
  std::optional<Job> claimed;
  {
    Statement update = connection.prepare(kClaim);
    update.bind(now, now + lease_micros, kLongestPauseMicros, kAgeingMicros, running_per_token, can_run(known));
    Result<std::optional<Job>> row = first_row(update, read_job);
    if (!row) {
      return row;
    }
    claimed = std::move(*row);
  }
  if (claimed) {
    if (Status noted = add_event(connection, claimed->id, "state", now); !noted) {
      return fail(noted.error());
    }
  }
  return claimed;
}

Result<LeaseStatus> renew(Connection& connection, const Lease& lease, std::int64_t lease_micros, UtcMicros now) {
  Statement update = connection.prepare(kRenew);
  update.bind(lease.job_id, lease.attempt, now + lease_micros);
  return fenced(update);
}

Result<LeaseStatus> report_progress(Connection& connection, const Lease& lease, std::string_view stage, double progress,
                                    UtcMicros now) {
  const double fraction = std::isfinite(progress) ? std::clamp(progress, 0.0, 1.0) : 0.0;
  LeaseStatus status;
  {
    Statement update = connection.prepare(kProgress);
    update.bind(lease.job_id, lease.attempt, stage, fraction);
    const Result<LeaseStatus> written = fenced(update);
    if (!written || !written->held) {
      return written;
    }
    status = *written;
  }
  if (Status noted = add_event(connection, lease.job_id, "progress", now); !noted) {
    return fail(noted.error());
  }
  return status;
}

Result<LeaseStatus> succeed(Connection& connection, const Lease& lease, const JobResults& results, UtcMicros now) {
  if (results.pooled) {
    const Result<HeldJob> held = held_job(connection, lease);
    if (!held) {
      return not_held(held.error());
    }
    const Result<bool> latest = pools_latest(connection, lease.job_id);
    if (!latest) {
      return fail(latest.error());
    }
    if (!*latest) {
      return moved(connection, connection.prepare(kCancel).bind(lease.job_id, now).run(), lease, true, now);
    }
  }
  LeaseStatus status;
  {
    Statement update = connection.prepare(kSucceed);
    update.bind(lease.job_id, lease.attempt, now);
    const Result<LeaseStatus> written = fenced(update);
    if (!written || !written->held) {
      return written;
    }
    status = *written;
  }
  Status written = insert_results(connection, lease.job_id, results, now);
  if (written && !results.channels.empty()) {
    const auto axes = axes_of_job(connection, lease.job_id);
    written = axes ? show_results(connection, *axes) : fail(axes.error());
    if (written) {
      written = refresh_pools(connection, *axes, now).map([](int) {});
    }
  }
  Result<LeaseStatus> finished = moved(connection, std::move(written), lease, status.cancel_requested, now);
  crash_point("job.in_finish");
  return finished;
}

Result<LeaseStatus> fail_attempt(Connection& connection, const Lease& lease, const AttemptFailure& failure,
                                 std::mt19937_64& jitter, UtcMicros now) {
  const Result<HeldJob> found = held_job(connection, lease);
  if (!found) {
    return not_held(found.error());
  }
  const HeldJob& job = *found;
  const int failures = std::min(job.failures + 1, job.max_failures);
  const int faults = std::min(job.faults + (failure.fault_signal ? 1 : 0), kMaxFaults);
  const int fault = failure.fault_signal ? 1 : 0;
  const std::string seal = seal_of_texts({lease.job_id, std::to_string(lease.attempt), std::to_string(job.started_at),
                                          std::to_string(now), std::to_string(fault), failure.problem_json});
  Status change = connection.prepare(kRememberFailure)
                      .bind(lease.job_id, lease.attempt, job.started_at, now, fault, failure.problem_json, seal)
                      .run();
  const std::optional<JobState> end = end_after(failure, job, failures, faults);
  if (change) {
    change =
        end ? connection.prepare(kFailToEnd)
                  .bind(lease.job_id, name_of(*end), now, failures, faults, failure.problem_json)
                  .run()
            : connection.prepare(kFailToQueue)
                  .bind(lease.job_id, now + draw_pause_micros(failures, jitter), failures, faults, failure.problem_json)
                  .run();
  }
  auto status = moved(connection, std::move(change), lease, job.cancel_requested, now);
  if (status) {
    status->dead = end == JobState::Dead;
  }
  return status;
}

Result<LeaseStatus> acknowledge_cancel(Connection& connection, const Lease& lease, UtcMicros now) {
  const Result<HeldJob> found = held_job(connection, lease);
  if (!found) {
    return not_held(found.error());
  }
  if (!found->cancel_requested) {
    return LeaseStatus{true, false};
  }
  return moved(connection, connection.prepare(kCancel).bind(lease.job_id, now).run(), lease, true, now);
}

Result<LeaseStatus> release(Connection& connection, const Lease& lease, UtcMicros now) {
  const Result<HeldJob> found = held_job(connection, lease);
  if (!found) {
    return not_held(found.error());
  }
  if (Status back = put_back(connection, lease.job_id, found->cancel_requested, now); !back) {
    return fail(back.error());
  }
  return LeaseStatus{true, found->cancel_requested};
}

Result<Job> request_cancel(Connection& connection, std::string_view id, UtcMicros now) {
  Result<Job> found = job(connection, id);
  if (!found || is_terminal(found->state) || found->cancel_requested) {
    return found;
  }
  Status change;
  if (found->state == JobState::Queued) {
    change = connection.prepare(kCancel).bind(id, now).run();
    if (change) {
      change = add_event(connection, id, "state", now);
    }
  } else {
    change = connection.prepare(kAskToCancel).bind(id).run();
  }
  if (!change) {
    return fail(change.error());
  }
  return job(connection, id);
}

Result<int> end_leases(Connection& connection, std::optional<UtcMicros> deadline, UtcMicros now) {
  struct Expired {
    std::string id;
    bool cancel_requested = false;
  };
  std::vector<Expired> expired;
  {
    Statement statement = connection.prepare(kExpired);
    statement.bind(deadline);
    Result<std::vector<Expired>> rows =
        all_rows<Expired>(statement, [](const Statement& row) { return Expired{row.text(0), row.integer(1) != 0}; });
    if (!rows) {
      return fail(rows.error());
    }
    expired = std::move(*rows);
  }
  for (const Expired& one : expired) {
    if (Status back = put_back(connection, one.id, one.cancel_requested, now); !back) {
      return fail(back.error());
    }
  }
  return static_cast<int>(expired.size());
}

}  // namespace driftlab::server::tables
