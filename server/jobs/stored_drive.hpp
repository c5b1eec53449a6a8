#pragma once
/// A drive document over stored recordings: its check, and its files for the use cases of core/analysis/drive.hpp.
#include "core/analysis/drive.hpp"
#include "server/jobs/stored_recordings.hpp"
#include "server/jobs/stored_sensor.hpp"

namespace driftlab::server {

/// What a document over stored recordings comes to.
struct CheckedDrive {
  Json document;  ///< its model says all by itself
  std::string device_id;
  Json recordings = Json::array();  ///< {"id", "revision"} of each, once
  Json left_out = Json::array();    ///< what a stored model says that a filter is not told
};

/// Checks the document at `pointer`: its members, its model, and that its recordings exist, belong to one device and
/// have the columns that it names. Faults are added with their pointers. Errors: those of the store; Conflict for a
/// model whose table is being pooled.
[[nodiscard]] Result<CheckedDrive> check_stored_drive(const Json& document, const std::string& pointer, Store& store,
                                                      Faults& faults);

/// The files of a checked document: columns as the uploads left them. References must outlive it.
class StoredDriveFiles final : public DriveSource {
 public:
  StoredDriveFiles(Store& store, BlobStore& blobs, const Json& recordings,
                   std::function<Status(const std::string&)> verify_columns)
      : store_(store),
        blobs_(blobs),
        wanted_(recordings_from_request(recordings)),
        verify_columns_(std::move(verify_columns)) {}

  /// Errors: NotFound; Conflict where the recording was revised since; those of the store and of ColumnFile::open.
  [[nodiscard]] Result<drive::Table> open(const drive::Source& source, const RunControl& control) override;

 private:
  Store& store_;
  BlobStore& blobs_;
  std::vector<StoredRecordingRequest> wanted_;
  std::function<Status(const std::string&)> verify_columns_;
};

}  // namespace driftlab::server
