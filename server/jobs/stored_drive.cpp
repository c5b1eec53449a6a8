#include "server/jobs/stored_drive.hpp"

#include "core/signal/find_column.hpp"
#include "schema/json/drive_document.hpp"
#include "server/jobs/stored_models.hpp"

#include <algorithm>

namespace driftlab::server {
namespace {

/// One source of a document, and where it stands in it.
struct PlacedSource {
  const drive::Source* source;
  std::string pointer;
};

std::vector<PlacedSource> sources_of(const drive::Document& document, const std::string& pointer) {
  std::vector<PlacedSource> sources{{&document.imu.source, pointer + "/imu"}};
  if (document.imu.force) {
    sources.push_back({&*document.imu.force, pointer + "/imu/accelerometer"});
  }
  sources.push_back({&document.gnss.source, pointer + "/gnss"});
  if (document.reference.source) {
    sources.push_back({&*document.reference.source, pointer + "/reference"});
  }
  if (document.odometer) {
    sources.push_back({&document.odometer->source, pointer + "/odometer"});
  }
  return sources;
}

/// The column names of a recording's file, as a table without rows.
Result<drive::Table> names_of(const Recording& recording, Store& store) {
  auto blob = store.blob(recording.blob_sha256);
  if (!blob) {
    return fail(blob.error());
  }
  drive::Table table;
  const std::optional<Blob>& row = *blob;
  auto names = row ? parse_json(row->columns_json) : Result<Json>(Json::array());
  if (!names) {
    return fail(names.error());
  }
  table.names = names->get<std::vector<std::string>>();
  return table;
}

void check_columns(const PlacedSource& placed, const drive::Table& table, Faults& faults) {
  for (const auto& [name, meaning] : placed.source->columns) {
    if (const auto found = find_column(table.names, name); !found) {
      faults.add(placed.pointer + "/columns", found.error());
    }
  }
  const drive::TimeMeaning& time = placed.source->time;
  if (!time.tag.empty()) {
    faults.add(placed.pointer + "/time/tag", ErrorCode::InvalidArgument,
               "A server has no time tags; give what the tag says as `dates`: {\"first_s\", \"last_s\"}.");
  }
  if (time.scale != drive::TimeScale::Row) {
    if (const auto found = find_column(table.names, time.column); !found) {
      faults.add(placed.pointer + "/time/column", found.error());
    }
  }
}

/// One recording of the document: it exists, belongs to the drive's device, and has the columns.
Status check_source(const PlacedSource& placed, Store& store, CheckedDrive& checked, Faults& faults) {
  const std::string& id = placed.source->file;
  const std::string where = placed.pointer + "/recording";
  auto recording = is_id(id, "rec") ? store.recording(id) : fail(ErrorCode::NotFound, "");
  if (!recording) {
    if (recording.error().code != ErrorCode::NotFound) {
      return fail(recording.error());
    }
    faults.add(where, ErrorCode::NotFound, "There is no recording " + id + ".");
    return {};
  }
  if (checked.device_id.empty()) {
    checked.device_id = recording->device_id;
  }
  if (recording->device_id != checked.device_id) {
    faults.add(
        where, ErrorCode::InvalidArgument,
        "The recording " + id + " belongs to another device than the unit's; upload all files of a drive to one.");
    return {};
  }
  const auto table = names_of(*recording, store);
  if (!table) {
    return fail(table.error());
  }
  check_columns(placed, *table, faults);
  const bool known = std::any_of(checked.recordings.begin(), checked.recordings.end(),
                                 [&](const Json& entry) { return entry["id"] == id; });
  if (!known) {
    checked.recordings.push_back(Json{{"id", id}, {"revision", recording->revision}});
  }
  return {};
}

}  // namespace

Result<CheckedDrive> check_stored_drive(const Json& document, const std::string& pointer, Store& store,
                                        Faults& faults) {
  CheckedDrive checked;
  checked.document = document;
  if (document.is_object() && document.contains("model")) {
    StoredSensors sensors;
    if (auto status = resolve_stored(checked.document["model"], pointer + "/model", store, sensors, faults); !status) {
      return fail(status.error());
    }
    for (Json& entry : sensors.left_out) {
      entry["where"] = entry["where"].get<std::string>().substr(pointer.size());
    }
    checked.left_out = std::move(sensors.left_out);
  }
  if (!faults.none()) {
    return checked;
  }
  const drive::Document made = drive_from_json(checked.document, faults, "recording", pointer);
  if (!faults.none()) {
    return checked;
  }
  for (const PlacedSource& placed : sources_of(made, pointer)) {
    if (auto status = check_source(placed, store, checked, faults); !status) {
      return fail(status.error());
    }
  }
  return checked;
}

Result<drive::Table> StoredDriveFiles::open(const drive::Source& source, const RunControl& /*control*/) {
  auto row = store_.recording(source.file);
  if (!row) {
    return fail(row.error());
  }
  const bool same = std::any_of(wanted_.begin(), wanted_.end(), [&](const StoredRecordingRequest& wanted) {
    return wanted.id == row->id && wanted.revision == row->revision;
  });
  if (!same) {
    return fail(ErrorCode::Conflict, "The recording was revised after the job was queued; queue it again.");
  }
  if (auto verified = verify_columns_ ? verify_columns_(row->blob_sha256) : Status{}; !verified) {
    return fail(verified.error());
  }
  auto columns = ColumnFile::open(blobs_.columns_path(row->blob_sha256));
  if (!columns) {
    return fail(columns.error());
  }
  drive::Table table = table_of(*columns);
  auto blob = store_.blob(row->blob_sha256);
  if (!blob) {
    return fail(blob.error());
  }
  if (const std::optional<Blob>& decoded = *blob) {
    const auto notes = parse_json(decoded->notes_json);
    table.notes = notes ? notes->get<std::vector<std::string>>() : std::vector<std::string>();
  }
  return table;
}

}  // namespace driftlab::server
