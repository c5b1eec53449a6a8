#include "server/store/sql/tables.hpp"

#include <nlohmann/json.hpp>

namespace driftlab::server::tables {
namespace {

constexpr std::string_view kSelectBlob =
    "SELECT sha256, bytes, format, compression, row_count, columns_json, notes_json, created_at, seal FROM blobs "
    "WHERE sha256 = ?";
constexpr std::string_view kInsertBlob =
    "INSERT INTO blobs (sha256, bytes, format, compression, row_count, columns_json, notes_json, created_at, seal) "
    "VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?) ON CONFLICT (sha256) DO NOTHING";
constexpr std::string_view kBlobHashes = "SELECT sha256 FROM blobs ORDER BY sha256";
constexpr std::string_view kRemoveUnusedBlob =
    "DELETE FROM blobs WHERE sha256 = ?1 AND NOT EXISTS (SELECT 1 FROM recordings WHERE blob_sha256 = ?1)";

#define DRIFTLAB_RECORDING_COLUMNS                                                                         \
  "id, device_id, blob_sha256, revision, metadata_json, condition, quality_json, created_at, updated_at, " \
  "tags_json, tags_revision, file_name, name, coalesce((SELECT max(job_id) FROM job_recordings WHERE "     \
  "recording_id = recordings.id), ''), seal"
constexpr std::string_view kSelect = "SELECT " DRIFTLAB_RECORDING_COLUMNS " FROM recordings";
constexpr std::string_view kById = "SELECT " DRIFTLAB_RECORDING_COLUMNS " FROM recordings WHERE id = ?";
constexpr std::string_view kStored =
    "SELECT id, device_id, blob_sha256, created_at FROM recordings WHERE id > ? ORDER BY id LIMIT ?";
constexpr std::string_view kByIds =
    "SELECT " DRIFTLAB_RECORDING_COLUMNS " FROM recordings WHERE id IN (SELECT value FROM json_each(?))";
constexpr std::string_view kByDeviceAndBlob =
    "SELECT " DRIFTLAB_RECORDING_COLUMNS " FROM recordings WHERE device_id = ? AND blob_sha256 = ?";
constexpr std::string_view kHasResult = "EXISTS (SELECT 1 FROM channel_results WHERE recording_id = recordings.id)";
/// Few of many, where a look for results would read every recording (migration 0027).
constexpr std::string_view kMayHaveNoResult = "id IN (SELECT recording_id FROM recordings_without_result)";
/// At most so many at once, for nobody else writes to SQLite meanwhile.
constexpr std::string_view kSettle =
    "DELETE FROM recordings_without_result WHERE recording_id IN (SELECT recording_id FROM recordings_without_result "
    "WHERE EXISTS (SELECT 1 FROM channel_results WHERE recording_id = recordings_without_result.recording_id) "
    "LIMIT 10000)";
/// What triggers keep of a keeper (migration 0028), with PostgreSQL as a row for each change since the last sweep.
#define DRIFTLAB_AMOUNT "SELECT coalesce(CAST(sum(number) AS BIGINT), 0), coalesce(CAST(sum(bytes) AS BIGINT), 0), "
constexpr std::string_view kUsageOf = DRIFTLAB_AMOUNT
    "CASE WHEN EXISTS (SELECT 1 FROM recordings WHERE device_id = ?1 AND blob_sha256 = ?2) THEN 1 ELSE 0 END "
    "FROM stored_amounts WHERE kept_by = 'device/' || ?1";
constexpr std::string_view kUsageOfToken = DRIFTLAB_AMOUNT
    "CASE WHEN EXISTS (SELECT 1 FROM recordings JOIN owners ON object_id = recordings.id WHERE blob_sha256 = ?2 AND "
    "token_id = ?1) THEN 1 ELSE 0 END FROM stored_amounts WHERE kept_by = 'token/' || ?1";
#undef DRIFTLAB_AMOUNT
constexpr std::string_view kBlobBytes =
    "SELECT coalesce(CAST(sum(bytes) AS BIGINT), 0) FROM stored_amounts WHERE kept_by = 'blobs'";
/// Rows that changes have added, with the one that was made of those before.
constexpr std::string_view kSettleAmounts =
    "WITH chosen AS (SELECT ctid AS place, kept_by FROM stored_amounts WHERE NOT settled LIMIT ?1), "
    "added AS (DELETE FROM stored_amounts WHERE ctid = ANY (ARRAY(SELECT place FROM chosen)) "
    "RETURNING kept_by, number, bytes), "
    "before AS (DELETE FROM stored_amounts WHERE settled AND kept_by IN (SELECT kept_by FROM chosen) "
    "RETURNING kept_by, number, bytes), "
    "made AS (INSERT INTO stored_amounts (kept_by, number, bytes, settled) "
    "SELECT kept_by, sum(number), sum(bytes), TRUE FROM (SELECT * FROM added UNION ALL SELECT * FROM before) AS gone "
    "GROUP BY kept_by HAVING sum(number) <> 0 OR sum(bytes) <> 0) "
    "SELECT count(*) FROM added";
constexpr std::string_view kRemoveOwners = "DELETE FROM owners WHERE object_id = ?";
constexpr std::string_view kInsert =
    "INSERT INTO recordings (id, device_id, blob_sha256, revision, metadata_json, condition, quality_json, created_at, "
    "updated_at, tags_json, file_name, name, seal) VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)";
constexpr std::string_view kUpdate =
    "UPDATE recordings SET metadata_json = ?2, condition = ?3, quality_json = ?4, revision = ?5, updated_at = ?6, "
    "tags_json = ?7, tags_revision = ?8, name = ?9, seal = ?10 WHERE id = ?1";
constexpr std::string_view kRemove = "DELETE FROM recordings WHERE id = ?";
constexpr std::string_view kDeviceExists = "SELECT 1 FROM devices WHERE id = ?";
/// A job names its inputs in its request; an id of 26 random characters occurs nowhere by chance.
constexpr std::string_view kLiveJob =
    "SELECT id FROM jobs WHERE state IN ('queued', 'running') AND instr(request_json, ?) > 0 LIMIT 1";
/// Of jobs that made results of the recording, that name it, or that pooled its results.
constexpr std::string_view kRemoveDocuments =
    "DELETE FROM job_results WHERE job_id IN (SELECT job_id FROM channel_results WHERE recording_id = ?1"
    " UNION SELECT id FROM jobs WHERE instr(request_json, ?1) > 0"
    " UNION SELECT pool.id FROM jobs AS pool JOIN channel_results AS member ON instr(pool.request_json, member.id) > 0"
    " WHERE pool.kind = 'pool' AND member.recording_id = ?1)";

Result<Blob> read_blob(const Statement& row) {
  Blob blob;
  blob.sha256 = row.text(0);
  blob.bytes = row.integer(1);
  blob.format = row.text(2);
  blob.compression = row.text(3);
  blob.rows = row.integer(4);
  blob.columns_json = row.text(5);
  blob.notes_json = row.text(6);
  blob.created_at = row.integer(7);
  return sound_row("blobs", row.text(0), std::move(blob), row.text(8));
}

Recording read_recording(const Statement& row) {
  Recording recording;
  recording.id = row.text(0);
  recording.device_id = row.text(1);
  recording.blob_sha256 = row.text(2);
  recording.revision = row.integer(3);
  recording.metadata_json = row.text(4);
  recording.condition = row.text(5);
  recording.quality_json = row.text(6);
  recording.created_at = row.integer(7);
  recording.updated_at = row.integer(8);
  recording.tags_json = row.text(9);
  recording.tags_revision = row.integer(10);
  recording.file_name = row.text(11);
  recording.name = row.text(12);
  recording.latest_job = row.text(13);
  return recording;
}

Result<Recording> read_sound_recording(const Statement& row) {
  return sound_row("recordings", row.text(0), read_recording(row), row.text(14));
}

StoredRecording read_stored(const Statement& row) { return {row.text(0), row.text(1), row.text(2), row.integer(3)}; }

std::string read_text(const Statement& row) { return row.text(0); }

/// `id` of the metadata, else the name of the file.
std::string called(const Recording& recording) {
  const nlohmann::json metadata = nlohmann::json::parse(recording.metadata_json, nullptr, false);
  const std::string id = metadata.is_object() ? metadata.value("id", std::string()) : std::string();
  return id.empty() ? recording.file_name : id;
}

Status insert_blob(Connection& connection, const Blob& blob, UtcMicros now) {
  return connection.prepare(kInsertBlob)
      .bind(blob.sha256, blob.bytes, blob.format, blob.compression, blob.rows, blob.columns_json, blob.notes_json, now,
            seal_of(blob))
      .run();
}

Status require_device(Connection& connection, const std::string& device_id) {
  Statement statement = connection.prepare(kDeviceExists);
  const Result<bool> exists = statement.bind(device_id).step();
  if (!exists) {
    return fail(exists.error());
  }
  if (!*exists) {
    return fail(ErrorCode::NotFound, "There is no device \"" + device_id + "\".", {{"device", device_id}});
  }
  return {};
}

Result<DeviceUsage> read_usage(Statement& statement) {
  return one_row(
      statement, +[](const Statement& row) { return DeviceUsage{row.integer(0), row.integer(1), row.integer(2) != 0}; },
      Error{ErrorCode::Internal, "The store counts nothing.", {}});
}

Error absent(std::string_view id) {
  return {ErrorCode::NotFound, "There is no recording \"" + std::string(id) + "\".", {{"recording", std::string(id)}}};
}

/// The recording as its row has it: whatever happened to that, it can be removed.
Result<Recording> damaged_or_not(Connection& connection, std::string_view id) {
  Statement statement = connection.prepare(kById);
  statement.bind(id);
  return one_row(statement, read_recording, absent(id));
}

tl::unexpected<Error> stale(const Recording& found) {
  return fail(ErrorCode::Conflict, "The recording was changed by somebody else in the meantime.",
              {{"revision", std::to_string(found.revision)}});
}

/// With its results, if no job is using it and, unless it may be, nothing names it.
Status remove_found(Connection& connection, std::string_view id, bool may_be_named, UtcMicros now) {
  Statement statement = connection.prepare(kLiveJob);
  statement.bind(id);
  const Result<std::vector<std::string>> users = all_rows(statement, read_text);
  if (!users) {
    return fail(users.error());
  }
  if (!users->empty()) {
    return fail(ErrorCode::Conflict, "Job " + users->front() + " is using the recording; wait for it or cancel it.",
                {{"job", users->front()}});
  }
  if (Status unnamed = may_be_named ? Status() : require_unnamed_recording(connection, id); !unnamed) {
    return unnamed;
  }
  if (Status removed = connection.prepare(kRemoveDocuments).bind(id).run(); !removed) {
    return removed;
  }
  const auto axes = axes_of_recording(connection, id);
  if (!axes) {
    return fail(axes.error());
  }
  for (const std::string_view removal : {kRemove, kRemoveOwners}) {
    if (Status removed = connection.prepare(removal).bind(id).run(); !removed) {
      return removed;
    }
  }
  if (Status shown = show_results(connection, *axes); !shown) {
    return shown;
  }
  return refresh_pools(connection, *axes, now).map([](int) {});
}

}  // namespace

Result<std::optional<Blob>> blob(Connection& connection, std::string_view sha256) {
  Statement statement = connection.prepare(kSelectBlob);
  statement.bind(sha256);
  return first_row(statement, read_blob);
}

Result<RecordingOutcome> add_recording(Connection& connection, const Blob& blob, const Recording& recording,
                                       UtcMicros now) {
  if (Status known = require_device(connection, recording.device_id); !known) {
    return fail(known.error());
  }
  Statement statement = connection.prepare(kByDeviceAndBlob);
  statement.bind(recording.device_id, blob.sha256);
  Result<std::vector<Recording>> existing = all_rows(statement, read_sound_recording);  // one at most
  if (!existing) {
    return fail(existing.error());
  }
  if (!existing->empty()) {
    Recording& same = existing->front();
    const bool other_tags = recording.tags_json != "{}" && same.tags_json != recording.tags_json;
    const bool other_metadata = same.metadata_json != recording.metadata_json || same.condition != recording.condition;
    if (other_metadata || other_tags) {
      const char* const differs = other_metadata ? "metadata" : "labels";
      return fail(ErrorCode::Conflict,
                  "The device has these bytes already, as recording " + same.id + " with other " + differs +
                      "; change that one instead.",
                  {{"recording_id", same.id}, {"differs", differs}});
    }
    return RecordingOutcome{std::move(same), false};
  }
  if (Status inserted = insert_blob(connection, blob, now); !inserted) {
    return fail(inserted.error());
  }
  Recording made = recording;
  if (made.id.empty()) {
    made.id = make_id("rec", now);
  }
  made.blob_sha256 = blob.sha256;
  made.revision = 1;
  made.tags_revision = 0;
  made.name = called(made);
  made.created_at = now;
  made.updated_at = now;
  Status inserted = connection.prepare(kInsert)
                        .bind(made.id, made.device_id, made.blob_sha256, made.revision, made.metadata_json,
                              made.condition, made.quality_json, made.created_at, made.updated_at, made.tags_json,
                              made.file_name, made.name, seal_of(made))
                        .run();
  if (!inserted) {
    return fail(inserted.error());
  }
  return tables::recording(connection, made.id).map([](Recording row) {
    return RecordingOutcome{std::move(row), true};
  });
}

Result<DeviceUsage> usage_of(Connection& connection, std::string_view device_id, std::string_view sha256) {
  Statement statement = connection.prepare(kUsageOf);
  return read_usage(statement.bind(device_id, sha256));
}

Result<DeviceUsage> usage_of_token(Connection& connection, std::string_view token, std::string_view sha256) {
  Statement statement = connection.prepare(kUsageOfToken);
  return read_usage(statement.bind(token, sha256));
}

Result<std::int64_t> blob_bytes(Connection& connection) {
  Statement statement = connection.prepare(kBlobBytes);
  return one_row(
      statement, +[](const Statement& row) { return row.integer(0); },
      Error{ErrorCode::Internal, "The store counts nothing.", {}});
}

Result<Recording> recording(Connection& connection, std::string_view id) {
  Statement statement = connection.prepare(kById);
  statement.bind(id);
  return one_row(statement, read_sound_recording, absent(id));
}

Result<std::vector<Recording>> recordings_of(Connection& connection, const std::vector<std::string>& ids) {
  Statement statement = connection.prepare(kByIds);
  statement.bind(nlohmann::json(ids).dump());
  return all_rows(statement, read_sound_recording);
}

Result<std::vector<Recording>> recordings(Connection& connection, const RecordingFilter& filter, const Page& page) {
  FilteredQuery query(kSelect);
  query.along("device_id", filter.device_id);
  query.along("condition", filter.condition);
  if (!filter.labels.empty()) {
    query.where("tags_json <> '{}'");  // an index has only those
  }
  for (const std::string& label : filter.labels) {
    query.where("EXISTS (SELECT 1 FROM json_each(tags_json, '$.labels') WHERE key || '=' || value = ?)", label);
  }
  query.holds("name || ' ' || file_name || ' ' || condition || ' ' || id", filter.text);
  query.made_since("rec", filter.since);
  if (filter.has_result) {
    if (!*filter.has_result) {
      query.where(kMayHaveNoResult);
    }
    query.where((*filter.has_result ? "" : "NOT ") + std::string(kHasResult));
  }
  return query.visible(page, "device_id").read_page(connection, page, read_sound_recording);
}

Result<int> settle_recordings(Connection& connection) {
  return connection.prepare(kSettle).run().map([&] { return connection.changes(); });
}

Result<bool> settle_amounts(Connection& connection) {
  if (connection.engine() != Engine::Postgres) {
    return false;
  }
  constexpr std::int64_t kAtOnce = 10000;
  Statement statement = connection.prepare(kSettleAmounts);
  statement.bind(kAtOnce);
  return one_row(
             statement, +[](const Statement& row) { return row.integer(0); },
             Error{ErrorCode::Internal, "The store counts nothing.", {}})
      .map([](std::int64_t rows) { return rows == kAtOnce; });
}

Result<Recording> revise_recording(Connection& connection, const Recording& changed, std::int64_t expected_revision,
                                   UtcMicros now) {
  Result<Recording> found = recording(connection, changed.id);
  if (!found) {
    return found;
  }
  if (found->revision != expected_revision || found->tags_revision != changed.tags_revision) {
    return stale(*found);
  }
  Recording revised = std::move(*found);
  const bool other_meaning = revised.metadata_json != changed.metadata_json || revised.tags_json == changed.tags_json;
  revised.tags_revision += revised.tags_json == changed.tags_json ? 0 : 1;
  revised.tags_json = changed.tags_json;
  revised.metadata_json = changed.metadata_json;
  revised.condition = changed.condition;
  revised.quality_json = changed.quality_json;
  revised.revision += other_meaning ? 1 : 0;
  revised.name = called(revised);
  revised.updated_at = now;
  Status updated =
      connection.prepare(kUpdate)
          .bind(revised.id, revised.metadata_json, revised.condition, revised.quality_json, revised.revision,
                revised.updated_at, revised.tags_json, revised.tags_revision, revised.name, seal_of(revised))
          .run();
  if (updated && other_meaning) {
    const auto axes = axes_of_recording(connection, revised.id);
    updated = axes ? refresh_pools(connection, *axes, now).map([](int) {}) : fail(axes.error());
  }
  return updated ? recording(connection, revised.id) : fail(updated.error());
}

Status remove_recording(Connection& connection, std::string_view id, std::int64_t expected_revision, UtcMicros now) {
  const Result<Recording> found = damaged_or_not(connection, id);
  if (!found) {
    return fail(found.error());
  }
  if (found->revision != expected_revision && expected_revision != Store::kAnyRevision) {
    return stale(*found);
  }
  // A damaged one stands in the way of what names it, and comes back by an upload.
  return remove_found(connection, id, expected_revision == Store::kAnyRevision, now);
}

Result<std::vector<StoredRecording>> stored_recordings(Connection& connection, std::string_view after, int most) {
  Statement statement = connection.prepare(kStored);
  statement.bind(after, most);
  return all_rows(statement, read_stored);
}

Status expire_recording(Connection& connection, std::string_view id, UtcMicros now) {
  const Result<Recording> found = damaged_or_not(connection, id);
  return found ? remove_found(connection, id, false, now) : fail(found.error());
}

Result<std::vector<std::string>> blob_hashes(Connection& connection) {
  Statement statement = connection.prepare(kBlobHashes);
  return all_rows(statement, read_text);
}

Result<bool> remove_unused_blob(Connection& connection, std::string_view sha256) {
  if (Status removed = connection.prepare(kRemoveUnusedBlob).bind(sha256).run(); !removed) {
    return fail(removed.error());
  }
  return connection.changes() > 0;
}

}  // namespace driftlab::server::tables
