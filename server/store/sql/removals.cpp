// Removing what others may depend on: refused, with their names, while anything does.
#include "server/store/sql/tables.hpp"

#include <utility>

namespace driftlab::server::tables {
namespace {

/// The dependents of one kind: how they are called, and the SELECT of their ids by the id of what they depend on.
struct Dependents {
  const char* one;
  const char* several;
  std::string_view select;
};

constexpr int kNamed = 5;  ///< ids in a refusal; the rest is counted

/// A job names its inputs in its request; an id of 26 random characters occurs nowhere by chance.
constexpr Dependents kLiveJobs{"running job", "running jobs",
                               "SELECT id, count(*) OVER () FROM jobs WHERE state IN ('queued', 'running') AND "
                               "instr(request_json, ?1) > 0 ORDER BY id LIMIT ?2"};

const std::vector<Dependents> kOfDevice{
    {"recording", "recordings",
     "SELECT id, count(*) OVER () FROM recordings WHERE device_id = ?1 ORDER BY id LIMIT ?2"},
    {"study", "studies", "SELECT id, count(*) OVER () FROM studies WHERE device_id = ?1 ORDER BY id LIMIT ?2"},
    {"drive", "drives", "SELECT id, count(*) OVER () FROM drives WHERE device_id = ?1 ORDER BY id LIMIT ?2"},
    {"calibration", "calibrations",
     "SELECT id, count(*) OVER () FROM calibrations WHERE device_id = ?1 ORDER BY id LIMIT ?2"},
    {"model", "models", "SELECT id, count(*) OVER () FROM models WHERE device_id = ?1 ORDER BY id LIMIT ?2"},
    {"investigation", "investigations",
     "SELECT id, count(*) OVER () FROM investigations WHERE device_id = ?1 ORDER BY id LIMIT ?2"},
    {"running job", "running jobs",
     "SELECT id, count(*) OVER () FROM jobs JOIN job_devices ON job_id = id WHERE state IN ('queued', 'running') AND "
     "device_id = ?1 ORDER BY id LIMIT ?2"}};
constexpr Dependents kStudiesThatName{
    "study", "studies",
    "SELECT id, count(*) OVER () FROM studies WHERE instr(document_json, ?1) > 0 ORDER BY id LIMIT ?2"};
const std::vector<Dependents> kOfRecording{
    kStudiesThatName,
    {"drive", "drives",
     "SELECT id, count(*) OVER () FROM drives WHERE instr(document_json, ?1) > 0 ORDER BY id LIMIT ?2"}};
const std::vector<Dependents> kOfStudy{
    {"investigation", "investigations",
     "SELECT id, count(*) OVER () FROM investigations WHERE study_id = ?1 ORDER BY id LIMIT ?2"},
    kLiveJobs};
const std::vector<Dependents> kOfDrive{kLiveJobs};
const std::vector<Dependents> kOfCalibration{
    {"recording", "recordings",
     "SELECT id, count(*) OVER () FROM recordings WHERE instr(metadata_json, ?1) > 0 ORDER BY id LIMIT ?2"},
    kStudiesThatName,
    kLiveJobs};
const std::vector<Dependents> kOfModel{
    {"model", "models", "SELECT id, count(*) OVER () FROM models WHERE parent_id = ?1 ORDER BY id LIMIT ?2"},
    {"investigation", "investigations",
     "SELECT id, count(*) OVER () FROM investigations WHERE baseline_id = ?1 OR model_id = ?1 ORDER BY id LIMIT ?2"},
    kLiveJobs};

/// Jobs that have ended and name no other device go with it, and their results with them.
constexpr std::string_view kRemoveJobsOfDevice =
    "DELETE FROM jobs WHERE id IN (SELECT job_id FROM job_devices WHERE device_id = ?1) AND NOT EXISTS "
    "(SELECT 1 FROM job_devices WHERE job_id = jobs.id AND device_id <> ?1)";
/// Those that name others too stay, without a device: what they say of this one is not for tokens of the others alone.
constexpr std::string_view kForgetDevicesOfJobs =
    "DELETE FROM job_devices WHERE job_id IN (SELECT job_id FROM job_devices WHERE device_id = ?1)";
constexpr std::string_view kRemovePools = "DELETE FROM pools WHERE device_id = ?";
constexpr std::string_view kRemoveDevice = "DELETE FROM devices WHERE id = ?";
constexpr std::string_view kRemoveStudy = "DELETE FROM studies WHERE id = ?";
constexpr std::string_view kRemoveDrive = "DELETE FROM drives WHERE id = ?";
constexpr std::string_view kRemoveCalibration = "DELETE FROM calibrations WHERE id = ?";
constexpr std::string_view kRemoveModel = "DELETE FROM models WHERE id = ?";
/// With its job, whose result it is: the same may then be asked for again.
constexpr std::string_view kRemoveInvestigation = "DELETE FROM jobs WHERE id = ?";
constexpr std::string_view kJobOfInvestigation = "SELECT job_id FROM investigations WHERE id = ?";
constexpr std::string_view kRemoveOwners = "DELETE FROM owners WHERE object_id = ?";

/// What is damaged can be removed: the row is there.
bool is_damaged(const Error& error) { return !damaged_row_of(error).empty(); }

using Named = std::pair<std::string, std::int64_t>;

/// Error: Conflict, with a sentence and a field for each kind that names the first of them.
Status require_free(Connection& connection, const std::vector<Dependents>& kinds, std::string_view what,
                    std::string_view id) {
  Error refusal{ErrorCode::Conflict, "", {}};
  for (const Dependents& kind : kinds) {
    Statement statement = connection.prepare(kind.select);
    statement.bind(id, kNamed);
    const auto found = all_rows(statement, +[](const Statement& row) { return Named{row.text(0), row.integer(1)}; });
    if (!found) {
      return fail(found.error());
    }
    if (found->empty()) {
      continue;
    }
    std::string ids;
    for (const Named& named : *found) {
      ids += (ids.empty() ? "" : ", ") + named.first;
    }
    const std::int64_t count = found->front().second;
    if (count > kNamed) {
      ids += " and " + std::to_string(count - kNamed) + " more";
    }
    refusal.message += (refusal.message.empty() ? "" : "; ") + std::to_string(count) + " " +
                       (count == 1 ? kind.one : kind.several) + " (" + ids + ")";
    refusal.fields.push_back({kind.several, ids});
  }
  if (refusal.fields.empty()) {
    return {};
  }
  refusal.message = "What depends on the " + std::string(what) + " must go first: " + refusal.message + ".";
  return fail(std::move(refusal));
}

/// Runs each statement with the id.
Status run_all(Connection& connection, const std::vector<std::string_view>& statements, std::string_view id) {
  for (const std::string_view sql : statements) {
    if (Status run = connection.prepare(sql).bind(id).run(); !run) {
      return run;
    }
  }
  return {};
}

/// A kind of what is made once and may be removed: what can depend on it, and the statements that remove it.
struct Removable {
  std::string_view what;
  const std::vector<Dependents>& dependents;
  std::vector<std::string_view> statements;
};

/// Removes what was found, damaged or not, once nothing depends on it.
template <class Row>
Status remove_found(Connection& connection, const Result<Row>& found, const Removable& kind, std::string_view id) {
  if (!found && !is_damaged(found.error())) {
    return fail(found.error());
  }
  if (Status unused = require_free(connection, kind.dependents, kind.what, id); !unused) {
    return unused;
  }
  return run_all(connection, kind.statements, id);
}

}  // namespace

Status require_unnamed_recording(Connection& connection, std::string_view id) {
  return require_free(connection, kOfRecording, "recording", id);
}

Status remove_device(Connection& connection, std::string_view id, std::int64_t expected_revision) {
  const Result<Device> found = device(connection, id);
  if (!found) {
    return fail(found.error());
  }
  if (found->revision != expected_revision) {
    return fail(ErrorCode::Conflict, "The device was changed by somebody else in the meantime.",
                {{"revision", std::to_string(found->revision)}});
  }
  if (Status unused = require_free(connection, kOfDevice, "device", found->id); !unused) {
    return unused;
  }
  return run_all(connection, {kRemoveJobsOfDevice, kForgetDevicesOfJobs, kRemovePools, kRemoveDevice}, found->id);
}

Status remove_study(Connection& connection, std::string_view id) {
  return remove_found(connection, study(connection, id), {"study", kOfStudy, {kRemoveStudy}}, id);
}

Status remove_drive(Connection& connection, std::string_view id) {
  return remove_found(connection, drive(connection, id), {"drive", kOfDrive, {kRemoveDrive}}, id);
}

Status remove_calibration(Connection& connection, std::string_view id) {
  return remove_found(connection, calibration(connection, id), {"calibration", kOfCalibration, {kRemoveCalibration}},
                      id);
}

Status remove_model(Connection& connection, std::string_view id) {
  return remove_found(connection, model(connection, id), {"model", kOfModel, {kRemoveModel, kRemoveOwners}}, id);
}

Status remove_investigation(Connection& connection, std::string_view id) {
  Statement statement = connection.prepare(kJobOfInvestigation);
  statement.bind(id);
  const auto job = one_row(statement, +[](const Statement& row) { return row.text(0); },
                           {ErrorCode::NotFound,
                            "There is no investigation \"" + std::string(id) + "\".",
                            {{"investigation", std::string(id)}}});
  return job ? run_all(connection, {kRemoveInvestigation, kRemoveOwners}, *job) : fail(job.error());
}

}  // namespace driftlab::server::tables
