#pragma once
/// The recordings of a request from what the server has stored (core/analysis/recording_source.hpp).
#include "core/analysis/recording_source.hpp"
#include "server/jobs/job_kind.hpp"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace driftlab::server {

/// One recording of a request.
struct StoredRecordingRequest {
  std::string id;
  std::optional<std::int64_t>
      revision;      ///< the very revision that was there when the job was queued; nothing: the latest
  std::string name;  ///< what the result calls it; empty: what its metadata call it
};

/// [{"id", "revision", "name"}] of a canonical request; `name` may be missing.
[[nodiscard]] std::vector<StoredRecordingRequest> recordings_from_request(const Json& list);

/// Texts that describe a device, in which its sensor may be named, most telling first: IMU, model, name.
[[nodiscard]] std::vector<std::string> hardware_of(const Device& device);

/// Rows from the store, columns mapped where the blob store keeps them. Not thread safe.
class StoredRecordings : public RecordingSource {
 public:
  /// References must outlive this object.
  /// `verify_columns` is that of a JobContext.
  StoredRecordings(Store& store, BlobStore& blobs, std::vector<StoredRecordingRequest> wanted,
                   std::function<Status(const std::string&)> verify_columns = {});

  [[nodiscard]] std::size_t count() const override { return wanted_.size(); }
  /// Errors: NotFound; Conflict where the recording was revised since; those of the store and of ColumnFile::open.
  [[nodiscard]] Result<SourceRecording> open(std::size_t index, const RunControl& control) override;
  /// Errors: InvalidArgument (no such calibration, or one of another device); those of the store.
  [[nodiscard]] Result<Calibration> calibration(std::size_t index) override;
  /// With the field "recording".
  [[nodiscard]] Error located(std::size_t index, Error error) const override;

  /// How many channels a recording has, as its columns are named (core/analysis/characterise_channels.hpp). Opens no
  /// file. Errors: those of `open` that the rows show.
  [[nodiscard]] Result<std::size_t> expected_channels(std::size_t index);

  /// The row of a recording that was opened, or of which `expected_channels` was asked.
  [[nodiscard]] const Recording& row(std::size_t index) const { return rows_[index]; }

 protected:
  /// Called for each row before it is opened; an error refuses it.
  [[nodiscard]] virtual Status admit(const Recording& /*row*/) const { return {}; }

 private:
  /// Reads the row and what it says of the recording.
  [[nodiscard]] Status read_row(std::size_t index);

  Store& store_;
  BlobStore& blobs_;
  std::function<Status(const std::string&)> verify_columns_;
  std::vector<StoredRecordingRequest> wanted_;
  std::vector<Recording> rows_;
  std::vector<RecordingSpec> specs_;  ///< the metadata of each whose row was read
};

}  // namespace driftlab::server
