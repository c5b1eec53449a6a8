/// How much there is, and what it comes to.
#include "server/store/sql/tables.hpp"

namespace driftlab::server::tables {
namespace {

constexpr std::string_view kVisibleDevicesAndRecordings =
    "SELECT (SELECT count(*) FROM devices WHERE name IN (SELECT value FROM json_each(?))), (SELECT count(*) FROM "
    "recordings JOIN devices ON devices.id = device_id WHERE devices.name IN (SELECT value FROM json_each(?)))";
constexpr std::string_view kCounts =
    "SELECT coalesce((SELECT CAST(sum(number) AS BIGINT) FROM stored_amounts WHERE kept_by = 'devices'), 0), "
    "coalesce((SELECT CAST(sum(number) AS BIGINT) FROM stored_amounts WHERE kept_by = 'recordings'), 0), "
    "(SELECT count(*) FROM jobs WHERE state = 'queued'), (SELECT count(*) FROM jobs WHERE state = 'running')";
/// Without `WHERE`: what ended since ?, as two sums.
constexpr std::string_view kEndedSince =
    "SELECT coalesce(sum(CASE WHEN state = 'succeeded' THEN 1 ELSE 0 END), 0), "
    "coalesce(sum(CASE WHEN state IN ('failed', 'dead') THEN 1 ELSE 0 END), 0) FROM jobs "
    "WHERE finished_at >= ? AND kind <> 'pool'";
constexpr std::string_view kSelectVerdict = "SELECT " DRIFTLAB_VERDICT_COLUMNS " FROM verdicts";
constexpr std::string_view kForgetRecording = "DELETE FROM verdicts WHERE recording_id = ?";
/// What the devices of a model said of one of them.
constexpr std::string_view kForgetLine =
    "DELETE FROM verdicts WHERE device_id = ? AND recording_id IS NULL AND channel = ?";
/// ?2 the job. A result that speaks of no device by itself is that of the only one which its job names.
constexpr std::string_view kInsertVerdict =
    "INSERT INTO verdicts (id, job_id, device_id, recording_id, channel, level, verdict, created_at, seal) VALUES (?1, "
    "?2, "
    "coalesce(?3, (SELECT max(device_id) FROM job_devices WHERE job_id = ?2 HAVING count(*) = 1)), ?4, ?5, ?6, ?7, ?8, "
    "?9)";

std::optional<std::string> some(const std::string& text) {
  return text.empty() ? std::nullopt : std::optional<std::string>(text);
}

}  // namespace

Result<ResultVerdict> read_verdict(const Statement& row) {
  return sound_row("verdicts", row.text(0),
                   ResultVerdict{row.text(0), row.text(1), row.text(2), row.text(3), row.text(4), row.text(5),
                                 row.text(6), row.text(7), row.text(8), row.text(9), row.integer(10)},
                   row.text(11));
}

Result<Counts> counts(Connection& connection, const std::optional<Visibility>& visible) {
  const std::string jobs = "(SELECT count(*) FROM jobs WHERE state = ? AND " + std::string(kVisibleJob) + ")";
  Statement statement = connection.prepare(
      visible ? std::string(kVisibleDevicesAndRecordings) + ", " + jobs + ", " + jobs : std::string(kCounts));
  if (visible) {
    statement.bind(visible->devices_json, visible->devices_json, "queued", visible->token, visible->devices_json,
                   "running", visible->token, visible->devices_json);
  }
  return one_row(
      statement,
      +[](const Statement& row) { return Counts{row.integer(0), row.integer(1), row.integer(2), row.integer(3)}; },
      Error{ErrorCode::Internal, "The store counts nothing.", {}});
}

Result<EndedCounts> ended_since(Connection& connection, UtcMicros since, const std::optional<Visibility>& visible) {
  std::string text(kEndedSince);
  if (visible) {
    text.append(" AND ").append(kVisibleJob);
  }
  Statement statement = connection.prepare(text);
  statement.bind(since);
  if (visible) {
    statement.bind(visible->token, visible->devices_json);
  }
  return one_row(
      statement, +[](const Statement& row) { return EndedCounts{row.integer(0), row.integer(1)}; },
      Error{ErrorCode::Internal, "The store counts nothing.", {}});
}

Result<std::vector<ResultVerdict>> verdicts(Connection& connection, const VerdictFilter& filter, const Page& page) {
  FilteredQuery query(kSelectVerdict);
  query.where("device_id = ?", filter.device_id);
  query.made_since("att", filter.since);
  if (filter.to_read) {
    query.where("level <> 'fine'");
  }
  if (page.visible) {
    query.where(kNotOfLine);
  }
  return query.visible_or_own(page, "device_id", "verdicts.job_id").read_page(connection, page, read_verdict);
}

Status insert_verdicts(Connection& connection, std::string_view job_id, const JobResults& results, UtcMicros now) {
  for (ResultVerdict made : results.verdicts) {
    const bool of_line = made.recording_id.empty() && !made.channel.empty();
    if (of_line || !made.recording_id.empty()) {
      Status forgotten = of_line ? connection.prepare(kForgetLine).bind(made.device_id, made.channel).run()
                                 : connection.prepare(kForgetRecording).bind(made.recording_id).run();
      if (!forgotten || made.verdict.empty()) {
        if (!forgotten) {
          return forgotten;
        }
        continue;
      }
    }
    made.id = made.id.empty() ? make_id("att", now) : made.id;
    made.job_id = job_id;
    Status inserted = connection.prepare(kInsertVerdict)
                          .bind(made.id, job_id, some(made.device_id), some(made.recording_id), made.channel,
                                made.level, made.verdict, now, seal_of(made))
                          .run();
    if (!inserted) {
      return inserted;
    }
  }
  return {};
}

}  // namespace driftlab::server::tables
