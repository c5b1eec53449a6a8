#include "server/store/retry_policy.hpp"
#include "server/store/sql/job_rows.hpp"
#include "server/store/sql/webhook_tables.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <functional>

namespace driftlab::server::tables {
namespace {

constexpr std::string_view kForgetEnded =
    "DELETE FROM jobs WHERE state IN ('failed', 'cancelled', 'dead') AND finished_at < ?";

/// What a job is about: the name of the one device, and of the one recording, that its request names.
#define DRIFTLAB_NAMED_JOBS                                                                                       \
  "SELECT " DRIFTLAB_JOB_COLUMNS                                                                                  \
  ", coalesce((SELECT CASE WHEN count(*) = 1 THEN min(devices.name) END FROM job_devices JOIN devices ON "        \
  "devices.id = job_devices.device_id WHERE job_devices.job_id = jobs.id), ''), "                                 \
  "coalesce((SELECT CASE WHEN count(*) = 1 THEN min(recordings.name) END FROM job_recordings JOIN recordings ON " \
  "recordings.id = job_recordings.recording_id WHERE job_recordings.job_id = jobs.id), '') FROM jobs"
constexpr std::string_view kSelect = DRIFTLAB_NAMED_JOBS;
constexpr std::string_view kNamedById = DRIFTLAB_NAMED_JOBS " WHERE id = ?";
constexpr std::string_view kEqualJob =
    DRIFTLAB_NAMED_JOBS " WHERE unique_key = ? AND state IN ('queued', 'running', 'succeeded')";
/// One that is damaged is made anew.
constexpr std::string_view kGiveUpKey = "UPDATE jobs SET unique_key = unique_key || ' ' || id WHERE id = ?";
constexpr std::string_view kInsert =
    "INSERT INTO jobs (id, kind, state, priority, max_failures, unique_key, request_json, run_at, created_at, seal) "
    "VALUES (?1, ?2, 'queued', ?3, ?4, ?5, ?6, ?7, ?7, ?8)";
/// ?1 texts of the request as a list, ?2 the job. Whatever of them is the id of something that a device has names that
/// device.
constexpr std::string_view kNoteDevices =
    "WITH named (id) AS (SELECT value FROM json_each(?1)) "
    "INSERT INTO job_devices (job_id, device_id) SELECT ?2, device_id FROM ("
    "SELECT devices.id AS device_id FROM named JOIN devices ON devices.id = named.id "
    "UNION SELECT recordings.device_id FROM named JOIN recordings ON recordings.id = named.id "
    "UNION SELECT studies.device_id FROM named JOIN studies ON studies.id = named.id "
    "UNION SELECT drives.device_id FROM named JOIN drives ON drives.id = named.id "
    "UNION SELECT calibrations.device_id FROM named JOIN calibrations ON calibrations.id = named.id "
    "UNION SELECT models.device_id FROM named JOIN models ON models.id = named.id WHERE models.device_id IS NOT NULL "
    "UNION SELECT fits.device_id FROM named JOIN fits ON fits.id = named.id "
    "UNION SELECT channel_results.device_id FROM named JOIN channel_results ON channel_results.id = named.id) AS found";
constexpr std::string_view kNoteRecordings =
    "INSERT INTO job_recordings (job_id, recording_id) SELECT DISTINCT ?2, recordings.id FROM json_each(?1) AS named "
    "JOIN recordings ON recordings.id = named.value";
/// The name of a scenario that ships or of one that the request holds, with the id of the job.
constexpr std::string_view kScenario =
    "coalesce(json_extract(request_json, '$.inputs.scenario.name'), json_extract(request_json, '$.inputs.scenario'), "
    "'') || ' ' || id";
constexpr std::string_view kAttempts =
    "SELECT job_id, attempt, started_at, failed_at, fault_signal, problem_json, seal FROM job_attempts WHERE job_id = "
    "? "
    "ORDER BY attempt";
constexpr std::string_view kEvents =
    "SELECT sequence, type, state, stage, progress, attempt, at FROM job_events WHERE job_id = ? AND sequence > ? "
    "ORDER BY sequence LIMIT ?";
constexpr std::string_view kAddEvent =
    "INSERT INTO job_events (job_id, type, state, stage, progress, attempt, at) "
    "SELECT id, ?2, state, stage, progress, attempt, ?3 FROM jobs WHERE id = ?1 RETURNING state";
constexpr std::string_view kById = "SELECT " DRIFTLAB_JOB_COLUMNS " FROM jobs WHERE id = ?";
constexpr std::string_view kSealEnd = "UPDATE jobs SET problem_json = ?2, end_seal = ?3 WHERE id = ?1";

/// Every text in a document that has the letters of an id, as a JSON list.
std::string possible_ids(const std::string& request_json) {
  nlohmann::json ids = nlohmann::json::array();
  const std::function<void(const nlohmann::json&)> collect = [&](const nlohmann::json& node) {
    if (node.is_structured()) {
      std::for_each(node.begin(), node.end(), collect);
    } else if (node.is_string()) {
      const auto& text = node.get_ref<const std::string&>();
      const bool plain = std::all_of(text.begin(), text.end(), [](unsigned char letter) {
        return letter == '_' || (letter >= '0' && letter <= '9') || (letter >= 'A' && letter <= 'Z') ||
               (letter >= 'a' && letter <= 'z');
      });
      if (plain && !text.empty()) {
        ids.push_back(text);
      }
    }
  };
  collect(nlohmann::json::parse(request_json, nullptr, false));
  return ids.dump();
}

/// The problem of a failed attempt, if its seal fits. Error: damaged_row.
Result<std::string> read_problem(const Statement& row) {
  const std::vector<std::string> texts{row.text(0), row.text(1), row.text(2), row.text(3), row.text(4), row.text(5)};
  if (!seal_fits(row.text(6), seal_of_texts({texts.begin(), texts.end()}))) {
    return fail(damaged_in("job_attempts", texts[0] + "/" + texts[1]));
  }
  return texts[5];
}

/// A state that is none is told as a damaged row.
Result<JobEvent> read_event(const Statement& row) {
  const auto state = parse_job_state(row.text(2));
  if (!state) {
    return fail(damaged_row("job_events", "event", row.text(0)));
  }
  JobEvent event;
  event.sequence = row.integer(0);
  event.type = row.text(1);
  event.state = *state;
  event.stage = row.text(3);
  event.progress = row.real(4);
  event.attempt = row.integer(5);
  event.at = row.integer(6);
  return event;
}

}  // namespace

std::string can_run(const std::vector<KnownKind>& known) {
  std::string list = "[";
  for (const KnownKind& kind : known) {
    for (int version = 0; version <= kind.version; ++version) {
      list.append(list.size() > 1 ? ",\"" : "\"").append(kind.name).append(" ");
      list.append(std::to_string(version)).append("\"");
    }
  }
  return list + "]";
}

Job read_job(const Statement& row) {
  Job job;
  job.id = row.text(0);
  job.kind = row.text(1);
  const auto state = parse_job_state(row.text(2));
  job.state = state.value_or(JobState::Queued);
  job.stage = row.text(3);
  job.progress = row.real(4);
  job.priority = static_cast<int>(row.integer(5));
  job.attempt = row.integer(6);
  job.failures = static_cast<int>(row.integer(7));
  job.max_failures = static_cast<int>(row.integer(8));
  job.unique_key = row.text(9);
  job.request_json = row.text(10);
  job.cancel_requested = row.integer(11) != 0;
  job.run_at = row.integer(12);
  job.lease_expires_at = row.optional_integer(13);
  job.created_at = row.integer(14);
  job.started_at = row.optional_integer(15);
  job.finished_at = row.optional_integer(16);
  job.problem_json = row.text(17);
  job.is_damaged = !state || !seal_fits(row.text(18), seal_of(job)) || !seal_fits(row.text(19), end_seal_of(job));
  return job;
}

namespace {

Job read_named_job(const Statement& row) {
  Job job = read_job(row);
  job.device_name = row.text(20);
  job.recording_name = row.text(21);
  return job;
}

Error no_job(std::string_view id) {
  return {ErrorCode::NotFound, "There is no job \"" + std::string(id) + "\".", {{"job", std::string(id)}}};
}

/// Of every failed attempt, oldest first. Error: damaged_row.
Result<std::vector<std::string>> attempt_problems(Connection& connection, std::string_view id) {
  Statement attempts = connection.prepare(kAttempts);
  attempts.bind(id);
  return all_rows(attempts, read_problem);
}

/// Until a job has ended, its row has no seal of its problem: that is the one of the attempt that failed last.
void take_problem(Job& job, const std::vector<std::string>& attempts) {
  if (!is_terminal(job.state)) {
    job.problem_json = attempts.empty() ? std::string() : attempts.back();
  }
}

/// The same where the attempts have not been read. A damaged attempt is told as a damaged job.
Status look_up_problem(Connection& connection, Job& job) {
  if (is_terminal(job.state) || (job.failures == 0 && job.problem_json.empty())) {
    return {};
  }
  const Result<std::vector<std::string>> problems = attempt_problems(connection, job.id);
  if (!problems && damaged_row_of(problems.error()).empty()) {
    return fail(problems.error());
  }
  job.is_damaged = job.is_damaged || !problems;
  take_problem(job, problems.value_or(std::vector<std::string>()));
  return {};
}

/// Seals what a job says that has just ended; its problem, which was not sealed before, as the last attempt has it.
Status seal_end(Connection& connection, std::string_view id) {
  Job ended;
  {
    Statement statement = connection.prepare(kById);
    statement.bind(id);
    Result<Job> found = one_row(statement, read_job, no_job(id));
    if (!found) {
      return fail(found.error());
    }
    ended = std::move(*found);
  }
  if (ended.state != JobState::Succeeded && ended.failures > 0) {
    auto problems = attempt_problems(connection, id);
    if (!problems && damaged_row_of(problems.error()).empty()) {
      return fail(problems.error());
    }
    if (problems && !problems->empty()) {
      ended.problem_json = std::move(problems->back());
    }
  }
  return connection.prepare(kSealEnd).bind(id, ended.problem_json, end_seal_of(ended)).run();
}

}  // namespace

Result<EnqueuedJob> enqueue(Connection& connection, const NewJob& job, UtcMicros now) {
  if (job.priority < 0 || job.priority > 9) {
    return fail(ErrorCode::InvalidArgument, "A priority is a number from 0 to 9.", {{"parameter", "priority"}});
  }
  if (job.kind.empty() || job.unique_key.empty()) {
    return fail(ErrorCode::InvalidArgument, "A job needs a kind and a unique key.", {{"parameter", "unique_key"}});
  }
  Statement equal = connection.prepare(kEqualJob);
  equal.bind(job.unique_key);
  Result<std::vector<Job>> existing = all_rows(equal, read_named_job);  // one at most
  if (!existing) {
    return fail(existing.error());
  }
  if (!existing->empty()) {
    Job& equal_job = existing->front();
    if (!equal_job.is_damaged || !is_terminal(equal_job.state)) {
      const Status taken = look_up_problem(connection, equal_job);
      return taken ? Result<EnqueuedJob>(EnqueuedJob{std::move(equal_job), false}) : fail(taken.error());
    }
    if (Status done = connection.prepare(kGiveUpKey).bind(equal_job.id).run(); !done) {
      return fail(done.error());
    }
  }
  Job made;
  made.id = make_id("job", now);
  made.kind = job.kind;
  made.request_json = job.request_json;
  const std::string& id = made.id;
  Status inserted =
      connection.prepare(kInsert)
          .bind(id, job.kind, job.priority, kMaxFailures, job.unique_key, job.request_json, now, seal_of(made))
          .run();
  if (inserted) {
    inserted = connection.prepare(kNoteDevices).bind(possible_ids(job.request_json), id).run();
  }
  if (inserted) {
    inserted = connection.prepare(kNoteRecordings).bind(possible_ids(job.request_json), id).run();
  }
  if (inserted) {
    inserted = add_event(connection, id, "state", now);
  }
  if (!inserted) {
    return fail(inserted.error());
  }
  return tables::job(connection, id).map([](Job queued) { return EnqueuedJob{std::move(queued), true}; });
}

Result<Job> job(Connection& connection, std::string_view id) {
  Statement statement = connection.prepare(kNamedById);
  statement.bind(id);
  return one_row(statement, read_named_job, no_job(id));
}

Result<Job> sound_job(Connection& connection, std::string_view id) {
  Result<Job> found = job(connection, id);
  if (!found || found->is_damaged) {
    return found ? fail(damaged_in("jobs", found->id)) : found;
  }
  Result<std::vector<std::string>> problems = attempt_problems(connection, id);
  if (!problems) {
    return fail(problems.error());
  }
  take_problem(*found, *problems);
  found->attempt_problems_json = std::move(*problems);
  return found;
}

Result<std::vector<Job>> jobs(Connection& connection, const JobFilter& filter, const Page& page) {
  FilteredQuery query(kSelect);
  query.where("kind = ?", filter.kind);
  if (filter.state && is_terminal(*filter.state) && *filter.state != JobState::Succeeded) {
    query.where("state IN ('failed', 'cancelled', 'dead')");  // an index has only those
  }
  query.where("state = ?", filter.state ? std::optional<std::string>(name_of(*filter.state)) : std::nullopt);
  query.where("json_extract(request_json, '$.inputs.device') = ?", filter.input_device);
  query.where("json_extract(request_json, '$.inputs.candidate.label') = ?", filter.candidate);
  query.where("EXISTS (SELECT 1 FROM job_devices WHERE job_devices.job_id = jobs.id AND job_devices.device_id = ?)",
              filter.device_id);
  query.holds(kScenario, filter.scenario);
  query.made_since("job", filter.since);
  Result<std::vector<Job>> found = query.visible_jobs(page).read_page(connection, page, read_named_job);
  if (!found) {
    return found;
  }
  for (Job& listed : *found) {
    if (Status taken = look_up_problem(connection, listed); !taken) {
      return fail(taken.error());
    }
  }
  return found;
}

Result<std::vector<JobEvent>> events_after(Connection& connection, std::string_view job_id, std::int64_t sequence,
                                           int limit) {
  Statement statement = connection.prepare(kEvents);
  statement.bind(job_id, sequence, limit);
  return all_rows(statement, read_event);
}

Status add_event(Connection& connection, std::string_view job_id, std::string_view type, UtcMicros now) {
  std::optional<JobState> state;
  {
    Statement statement = connection.prepare(kAddEvent);
    statement.bind(job_id, type, now);
    const Result<bool> added = statement.step();
    if (!added) {
      return fail(added.error());
    }
    state = *added ? parse_job_state(statement.text(0)) : std::nullopt;
  }
  if (type != "state" || !state || !is_terminal(*state)) {
    return {};
  }
  const Status sealed = seal_end(connection, job_id);
  return sealed ? fill_outbox(connection, job_id, now) : sealed;
}

Result<int> forget_ended_jobs(Connection& connection, UtcMicros before) {
  if (Status forgotten = connection.prepare(kForgetEnded).bind(before).run(); !forgotten) {
    return fail(forgotten.error());
  }
  return connection.changes();
}

}  // namespace driftlab::server::tables
