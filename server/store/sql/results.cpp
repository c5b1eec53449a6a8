#include "server/store/sql/tables.hpp"

namespace driftlab::server::tables {
namespace {

constexpr std::string_view kInsertDocument =
    "INSERT INTO job_results (job_id, document_json, created_at, seal) VALUES (?, ?, ?, ?)";
constexpr std::string_view kInsertChannel =
    "INSERT INTO channel_results (id, job_id, device_id, recording_id, recording_revision, channel, quantity, axis, "
    "condition, document_json, settings_json, created_at, glance_json, glance_level, seal) VALUES (?, ?, ?, ?, "
    "?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)";
constexpr std::string_view kInsertFit =
    "INSERT INTO fits (id, channel_result_id, job_id, device_id, recording_id, recording_revision, channel, quantity, "
    "axis, condition, model, rank, document_json, created_at, seal) VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, "
    "?)";
constexpr std::string_view kDocument = "SELECT job_id, document_json, seal FROM job_results WHERE job_id = ?";
constexpr std::string_view kSelectFit =
    "SELECT id, channel_result_id, job_id, device_id, recording_id, recording_revision, channel, quantity, axis, "
    "condition, model, rank, document_json, created_at, seal FROM fits";
constexpr std::string_view kFitById =
    "SELECT id, channel_result_id, job_id, device_id, recording_id, recording_revision, channel, quantity, axis, "
    "condition, model, rank, document_json, created_at, seal FROM fits WHERE id = ?";
/// Of the latest result of its recording and channel.
constexpr std::string_view kFitIsLatest =
    "NOT EXISTS (SELECT 1 FROM channel_results AS mine JOIN channel_results AS later "
    "ON later.recording_id = mine.recording_id AND later.channel = mine.channel AND later.sequence > mine.sequence "
    "WHERE mine.id = fits.channel_result_id)";
/// Constant text: what the latest results of an axis are, and in which order, is written once.
#define DRIFTLAB_LATEST_RESULTS                                                                                     \
  " FROM channel_results AS r "                                                                                     \
  "JOIN recordings AS recording ON recording.id = r.recording_id AND recording.revision = r.recording_revision "    \
  "WHERE r.device_id = ? AND r.quantity = ? AND r.axis = ? AND NOT EXISTS (SELECT 1 FROM channel_results AS later " \
  "WHERE later.recording_id = r.recording_id AND later.channel = r.channel "                                        \
  "AND later.recording_revision = r.recording_revision AND later.sequence > r.sequence) "                           \
  "ORDER BY r.condition, recording.blob_sha256, r.channel"
constexpr std::string_view kLatestChannels =
    "SELECT r.id, r.job_id, r.device_id, r.recording_id, r.recording_revision, r.channel, r.quantity, r.axis, "
    "r.condition, r.document_json, r.settings_json, r.created_at, r.glance_json, r.glance_level, "
    "r.seal" DRIFTLAB_LATEST_RESULTS;
constexpr std::string_view kLatestIds = "SELECT r.id" DRIFTLAB_LATEST_RESULTS;
/// Each by whether any result of a recording's current revision is about it, which the index of axes answers however
/// many there are.
constexpr std::string_view kAxesWithResults =
    "SELECT axis FROM (SELECT 'x' AS axis UNION ALL SELECT 'y' UNION ALL SELECT 'z') AS named WHERE EXISTS (SELECT 1 "
    "FROM channel_results AS r "
    "JOIN recordings AS recording ON recording.id = r.recording_id AND recording.revision = r.recording_revision "
    "WHERE r.device_id = ? AND r.quantity = ? AND r.axis = named.axis) ORDER BY axis";

std::string read_text(const Statement& row) { return row.text(0); }

Result<std::string> read_document(const Statement& row) {
  return sound_text("job_results", {row.text(0), row.text(1)}, row.text(2));
}

Result<Fit> read_fit(const Statement& row) {
  Fit fit;
  fit.id = row.text(0);
  fit.channel_result_id = row.text(1);
  fit.job_id = row.text(2);
  fit.device_id = row.text(3);
  fit.recording_id = row.text(4);
  fit.recording_revision = row.integer(5);
  fit.channel = row.text(6);
  fit.quantity = row.text(7);
  fit.axis = row.text(8);
  fit.condition = row.text(9);
  fit.model = row.text(10);
  fit.rank = static_cast<int>(row.integer(11));
  fit.document_json = row.text(12);
  fit.created_at = row.integer(13);
  return sound_row("fits", row.text(0), std::move(fit), row.text(14));
}

Result<ChannelResult> read_channel(const Statement& row) {
  ChannelResult channel;
  channel.id = row.text(0);
  channel.job_id = row.text(1);
  channel.device_id = row.text(2);
  channel.recording_id = row.text(3);
  channel.recording_revision = row.integer(4);
  channel.channel = row.text(5);
  channel.quantity = row.text(6);
  channel.axis = row.text(7);
  channel.condition = row.text(8);
  channel.document_json = row.text(9);
  channel.settings_json = row.text(10);
  channel.created_at = row.integer(11);
  channel.glance.json = row.text(12);
  channel.glance.level = static_cast<int>(row.integer(13));
  return sound_row("channel_results", row.text(0), std::move(channel), row.text(14));
}

Status insert_channel(Connection& connection, std::string_view job_id, ChannelResult channel, UtcMicros now) {
  channel.job_id = job_id;
  return connection.prepare(kInsertChannel)
      .bind(channel.id, job_id, channel.device_id, channel.recording_id, channel.recording_revision, channel.channel,
            channel.quantity, channel.axis, channel.condition, channel.document_json, channel.settings_json, now,
            channel.glance.json, channel.glance.level, seal_of(channel))
      .run();
}

Status insert_fit(Connection& connection, std::string_view job_id, Fit fit, UtcMicros now) {
  fit.id = fit.id.empty() ? make_id("fit", now) : fit.id;
  fit.job_id = job_id;
  return connection.prepare(kInsertFit)
      .bind(fit.id, fit.channel_result_id, job_id, fit.device_id, fit.recording_id, fit.recording_revision, fit.channel,
            fit.quantity, fit.axis, fit.condition, fit.model, fit.rank, fit.document_json, now, seal_of(fit))
      .run();
}

}  // namespace

Status insert_results(Connection& connection, std::string_view job_id, const JobResults& results, UtcMicros now) {
  Status inserted = connection.prepare(kInsertDocument)
                        .bind(job_id, results.document_json, now, seal_of_texts({job_id, results.document_json}))
                        .run();
  for (auto channel = results.channels.begin(); inserted && channel != results.channels.end(); ++channel) {
    inserted = insert_channel(connection, job_id, *channel, now);
  }
  for (auto fit = results.fits.begin(); inserted && fit != results.fits.end(); ++fit) {
    inserted = insert_fit(connection, job_id, *fit, now);
  }
  if (inserted) {
    inserted = insert_artefacts(connection, job_id, results);
  }
  if (inserted) {
    inserted = insert_investigations(connection, job_id, results, now);
  }
  return inserted ? insert_verdicts(connection, job_id, results, now) : inserted;
}

Result<std::string> result_document(Connection& connection, std::string_view job_id) {
  Statement statement = connection.prepare(kDocument);
  statement.bind(job_id);
  return one_row(
      statement, read_document,
      {ErrorCode::NotFound, "Job \"" + std::string(job_id) + "\" has no result.", {{"job", std::string(job_id)}}});
}

Result<Fit> fit(Connection& connection, std::string_view id) {
  Statement statement = connection.prepare(kFitById);
  statement.bind(id);
  return one_row(statement, read_fit,
                 {ErrorCode::NotFound, "There is no fit \"" + std::string(id) + "\".", {{"fit", std::string(id)}}});
}

Result<std::vector<Fit>> fits(Connection& connection, const FitFilter& filter, const Page& page) {
  FilteredQuery query(kSelectFit);
  query.along("job_id", filter.job_id);
  query.along("recording_id", filter.recording_id);
  query.along("device_id", filter.device_id);
  query.along("model", filter.model);
  query.where("quantity = ?", filter.quantity);
  query.where("axis = ?", filter.axis);
  if (filter.best_only.value_or(false)) {
    query.where("rank = 0");
  }
  if (filter.latest_only) {
    query.where(kFitIsLatest);
  }
  return query.visible(page, "device_id").read_page(connection, page, read_fit);
}

Result<std::vector<std::string>> latest_result_ids(Connection& connection, const SensorAxis& axis) {
  Statement statement = connection.prepare(kLatestIds);
  statement.bind(axis.device_id, axis.quantity, axis.axis);
  return all_rows(statement, read_text);
}

Result<std::vector<std::string>> axes_with_results(Connection& connection, std::string_view device_id,
                                                   std::string_view quantity) {
  Statement statement = connection.prepare(kAxesWithResults);
  statement.bind(device_id, quantity);
  return all_rows(statement, read_text);
}

Result<std::vector<ChannelResult>> latest_channel_results(Connection& connection, std::string_view device_id,
                                                          std::string_view quantity, std::string_view axis) {
  Statement statement = connection.prepare(kLatestChannels);
  statement.bind(device_id, quantity, axis);
  return all_rows(statement, read_channel);
}

}  // namespace driftlab::server::tables
