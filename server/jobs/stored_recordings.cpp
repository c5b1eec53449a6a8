#include "server/jobs/stored_recordings.hpp"

#include "core/analysis/characterise_channels.hpp"
#include "schema/json/recording_spec.hpp"
#include "server/jobs/recording_calibration.hpp"

#include <utility>

namespace driftlab::server {

std::vector<std::string> hardware_of(const Device& device) { return {device.imu, device.model, device.name}; }

std::vector<StoredRecordingRequest> recordings_from_request(const Json& list) {
  std::vector<StoredRecordingRequest> wanted;
  for (const Json& entry : list) {
    wanted.push_back({entry.at("id").get<std::string>(), entry.at("revision").get<std::int64_t>(),
                      entry.value("name", std::string())});
  }
  return wanted;
}

StoredRecordings::StoredRecordings(Store& store, BlobStore& blobs, std::vector<StoredRecordingRequest> wanted,
                                   std::function<Status(const std::string&)> verify_columns)
    : store_(store),
      blobs_(blobs),
      verify_columns_(std::move(verify_columns)),
      wanted_(std::move(wanted)),
      rows_(wanted_.size()),
      specs_(wanted_.size()) {}

Status StoredRecordings::read_row(std::size_t index) {
  const StoredRecordingRequest& wanted = wanted_[index];
  auto row = store_.recording(wanted.id);
  if (!row) {
    return fail(row.error());
  }
  if (const Status admitted = admit(*row); !admitted) {
    return fail(admitted.error());
  }
  if (wanted.revision && row->revision != *wanted.revision) {
    return fail(ErrorCode::Conflict,
                "The recording " + row->id + " was revised after the job was queued; queue it again.");
  }
  auto metadata = parse_json(row->metadata_json);
  if (!metadata) {
    return fail(metadata.error());
  }
  Faults faults;
  RecordingSpec spec = recording_spec_from_json(*metadata, "", faults);
  if (!faults.none()) {
    return fail(faults.error());
  }
  specs_[index] = std::move(spec);
  rows_[index] = std::move(*row);
  return {};
}

Result<std::size_t> StoredRecordings::expected_channels(std::size_t index) {
  if (const Status read = read_row(index); !read) {
    return fail(read.error());
  }
  const auto blob = store_.blob(rows_[index].blob_sha256);
  if (!blob) {
    return fail(blob.error());
  }
  const std::optional<Blob>& stored = *blob;
  const auto names = stored ? parse_json(stored->columns_json) : Result<Json>(Json::array());
  if (!names) {
    return fail(names.error());
  }
  return driftlab::expected_channels(specs_[index], names->get<ColumnNames>());
}

Result<SourceRecording> StoredRecordings::open(std::size_t index, const RunControl& /*control*/) {
  if (const Status read = read_row(index); !read) {
    return fail(read.error());
  }
  const std::string& blob = rows_[index].blob_sha256;
  if (auto verified = verify_columns_ ? verify_columns_(blob) : Status{}; !verified) {
    return fail(verified.error());
  }
  auto columns = ColumnFile::open(blobs_.columns_path(blob));
  if (!columns) {
    return fail(columns.error());
  }
  RecordingSpec spec = specs_[index];
  if (!wanted_[index].name.empty()) {
    spec.id = wanted_[index].name;
  }
  const auto device = store_.device(rows_[index].device_id);
  if (!device) {
    return fail(device.error());
  }
  return SourceRecording{std::move(spec), std::move(*columns), {}, hardware_of(*device), device->name};
}

Result<Calibration> StoredRecordings::calibration(std::size_t index) {
  return calibration_of(store_, specs_[index], rows_[index].device_id);
}

Error StoredRecordings::located(std::size_t index, Error error) const {
  return std::move(error).with("recording", wanted_[index].id);
}

}  // namespace driftlab::server
