/// Which job pools the latest results of a sensor axis. The row of an axis changes in the transaction that changes the
/// set of these results, so that at no moment a pooled document stands for results it was not made of.
#include "server/store/pool_job.hpp"
#include "server/store/sql/job_rows.hpp"

#include <algorithm>

namespace driftlab::server::tables {
namespace {

constexpr std::string_view kPool = "SELECT unique_key FROM pools WHERE device_id = ? AND quantity = ? AND axis = ?";
constexpr std::string_view kReplace =
    "INSERT INTO pools (device_id, quantity, axis, unique_key) VALUES (?, ?, ?, ?) "
    "ON CONFLICT (device_id, quantity, axis) DO UPDATE SET unique_key = excluded.unique_key";
constexpr std::string_view kRemove = "DELETE FROM pools WHERE device_id = ? AND quantity = ? AND axis = ?";
constexpr std::string_view kPoolsLatest =
    "SELECT 1 FROM jobs JOIN pools ON pools.unique_key = jobs.unique_key WHERE jobs.id = ?";
/// The job that lives or has succeeded, else the last one that ended otherwise.
constexpr std::string_view kJobOfKey =
    "SELECT " DRIFTLAB_JOB_COLUMNS
    " FROM jobs WHERE unique_key = ? ORDER BY state IN ('queued', 'running', 'succeeded') DESC, id DESC LIMIT 1";
constexpr std::string_view kDropResult = "DELETE FROM job_results WHERE job_id = ?";
/// A job that pooled what is no longer the latest gives up its key: should the set come back, it is pooled again.
constexpr std::string_view kGiveUpKey = "UPDATE jobs SET unique_key = unique_key || ' ' || id WHERE id = ?";
constexpr std::string_view kTakePlace = "UPDATE jobs SET run_at = ?2 WHERE id = ?1 AND run_at > ?2";
/// Axes that have results to pool and no pool, and pools whose job is gone or is of another version. Of all others the
/// row was written with the results that it names: however many there are, nothing is read of them but their keys.
constexpr std::string_view kAxesWithoutPool =
    "SELECT device_id, quantity, axis FROM channel_results WHERE axis <> '' GROUP BY device_id, quantity, axis "
    "HAVING count(DISTINCT recording_id) > 1 EXCEPT SELECT device_id, quantity, axis FROM pools UNION "
    "SELECT pools.device_id, pools.quantity, pools.axis FROM pools LEFT JOIN jobs ON jobs.unique_key = "
    "pools.unique_key WHERE jobs.id IS NULL OR jobs.request_json NOT LIKE ?";
/// Also those that results of before have, of recordings whose columns had another meaning then.
constexpr std::string_view kAxesOfJob =
    "SELECT DISTINCT device_id, quantity, axis FROM channel_results WHERE recording_id IN (SELECT recording_id FROM "
    "channel_results WHERE job_id = ?)";
constexpr std::string_view kAxesOfRecording =
    "SELECT DISTINCT device_id, quantity, axis FROM channel_results WHERE recording_id = ?";

std::string read_text(const Statement& row) { return row.text(0); }

SensorAxis read_axis(const Statement& row) { return {row.text(0), row.text(1), row.text(2)}; }

/// The key in the row of the axis.
Result<std::optional<std::string>> pool_key(Connection& connection, const SensorAxis& axis) {
  Statement statement = connection.prepare(kPool);
  statement.bind(axis.device_id, axis.quantity, axis.axis);
  return first_row(statement, read_text);
}

Result<std::optional<Job>> job_of_key(Connection& connection, const std::string& key) {
  Statement statement = connection.prepare(kJobOfKey);
  statement.bind(key);
  return first_row(statement, read_job);
}

/// Ends what pooled an older set and drops what it found, which would otherwise be kept for every state a campaign went
/// through. The time since which the job waited, where it was still queued.
Result<std::optional<UtcMicros>> retire(Connection& connection, const std::string& key, UtcMicros now) {
  const Result<std::optional<Job>> found = job_of_key(connection, key);
  if (!found) {
    return fail(found.error());
  }
  const std::optional<Job>& job = *found;
  if (!job) {
    return std::optional<UtcMicros>();
  }
  if (auto asked = request_cancel(connection, job->id, now); !asked) {
    return fail(asked.error());
  }
  for (const std::string_view sql : {kDropResult, kGiveUpKey}) {
    if (Status done = connection.prepare(sql).bind(job->id).run(); !done) {
      return fail(done.error());
    }
  }
  return job->state == JobState::Queued ? std::optional(job->run_at) : std::nullopt;
}

/// Queues the job of a new set, in the place in the queue of the one it replaces: a stream of results may put off the
/// pooling, but not for ever.
Status replace(Connection& connection, const SensorAxis& axis, const NewJob& job, std::optional<UtcMicros> place,
               UtcMicros now) {
  if (Status replaced =
          connection.prepare(kReplace).bind(axis.device_id, axis.quantity, axis.axis, job.unique_key).run();
      !replaced) {
    return replaced;
  }
  const Result<EnqueuedJob> queued = enqueue(connection, job, now);
  if (!queued) {
    return fail(queued.error());
  }
  return place ? connection.prepare(kTakePlace).bind(queued->job.id, *place).run() : Status{};
}

/// The row of the axis names its latest results. True where it did not before, and a job was queued.
Result<bool> refresh_pool(Connection& connection, const SensorAxis& axis, UtcMicros now) {
  auto members = latest_result_ids(connection, axis);
  const auto before = pool_key(connection, axis);
  if (!members || !before) {
    return fail(members ? before.error() : members.error());
  }
  const bool wanted = members->size() >= 2;
  const NewJob job = pool_job(axis, std::move(*members));
  std::optional<UtcMicros> place;
  if (const std::optional<std::string>& key = *before) {
    if (wanted && *key == job.unique_key) {
      return false;
    }
    auto retired = retire(connection, *key, now);
    if (!retired) {
      return fail(retired.error());
    }
    place = *retired;
  }
  const Status changed = wanted ? replace(connection, axis, job, place, now)
                                : connection.prepare(kRemove).bind(axis.device_id, axis.quantity, axis.axis).run();
  return changed ? Result<bool>(wanted) : fail(changed.error());
}

}  // namespace

Result<int> refresh_pools(Connection& connection, const std::vector<SensorAxis>& axes, UtcMicros now) {
  int queued = 0;
  for (const SensorAxis& axis : axes) {
    if (axis.axis.empty()) {
      continue;  // channels without an axis are not pooled
    }
    const Result<bool> refreshed = refresh_pool(connection, axis, now);
    if (!refreshed) {
      return fail(refreshed.error());
    }
    queued += *refreshed ? 1 : 0;
  }
  return queued;
}

Result<int> queue_missing_pools(Connection& connection, UtcMicros now) {
  Result<std::vector<SensorAxis>> axes = std::vector<SensorAxis>();
  {
    Statement statement = connection.prepare(kAxesWithoutPool);
    statement.bind(R"({"algorithm_version":)" + std::to_string(kPoolVersion) + ",%");
    axes = all_rows(statement, read_axis);
  }
  return axes ? refresh_pools(connection, *axes, now) : fail(axes.error());
}

Result<std::vector<SensorAxis>> axes_of_job(Connection& connection, std::string_view job_id) {
  Statement statement = connection.prepare(kAxesOfJob);
  statement.bind(job_id);
  return all_rows(statement, read_axis);
}

Result<std::vector<SensorAxis>> axes_of_recording(Connection& connection, std::string_view recording_id) {
  Statement statement = connection.prepare(kAxesOfRecording);
  statement.bind(recording_id);
  return all_rows(statement, read_axis);
}

Result<bool> pools_latest(Connection& connection, std::string_view job_id) {
  Statement statement = connection.prepare(kPoolsLatest);
  return statement.bind(job_id).step();
}

Result<std::optional<PooledArtefact>> pooled_artefact(Connection& connection, const SensorAxis& axis,
                                                      std::string_view name) {
  const auto named = pool_key(connection, axis);
  if (!named) {
    return fail(named.error());
  }
  const std::optional<std::string>& key = *named;
  if (!key) {
    return std::optional<PooledArtefact>();
  }
  const auto found = job_of_key(connection, *key);
  if (!found) {
    return fail(found.error());
  }
  const std::optional<Job>& job = *found;
  if (!job || job->is_damaged || job->state != JobState::Succeeded) {
    return std::optional<PooledArtefact>();
  }
  auto content = artefact(connection, job->id, name);
  if (!content) {
    return content.error().code == ErrorCode::NotFound ? Result<std::optional<PooledArtefact>>(std::nullopt)
                                                       : fail(content.error());
  }
  return std::optional(PooledArtefact{job->id, std::move(*content)});
}

Result<AxisResults> axis_results(Connection& connection, const SensorAxis& axis) {
  auto latest = latest_channel_results(connection, axis.device_id, axis.quantity, axis.axis);
  const auto pooled = pool_key(connection, axis);
  if (!latest || !pooled) {
    return fail(latest ? pooled.error() : latest.error());
  }
  AxisResults results;
  results.latest = std::move(*latest);
  if (const auto& key = *pooled) {
    auto job = job_of_key(connection, *key);
    if (!job) {
      return fail(job.error());
    }
    results.pool = std::move(*job);
    if (results.pool && results.pool->is_damaged) {
      return fail(damaged_in("jobs", results.pool->id));
    }
  }
  if (results.pool && results.pool->state == JobState::Succeeded) {
    auto document = result_document(connection, results.pool->id);
    if (!document) {
      return fail(document.error());
    }
    results.pooled_json = std::move(*document);
  }
  return results;
}

}  // namespace driftlab::server::tables
