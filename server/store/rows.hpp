#pragma once
/// What the store keeps, as plain values. Members ending in `_json` hold a JSON document as text: the store neither
/// reads nor changes it.
#include "server/store/clock.hpp"

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace driftlab::server {

struct Device {
  std::string id;    ///< `dev_...`
  std::string name;  ///< the user's identifier, unique: `phone-07`
  std::string model;
  std::string imu;
  std::string serial;
  std::string labels_json = "{}";
  std::int64_t revision = 1;  ///< grows with every change; the ETag
  UtcMicros created_at = 0;
  UtcMicros updated_at = 0;
};

/// Uploaded bytes by content, and what decoding found in them. The bytes and the decoded columns lie beside the
/// database (server/store/blobs.hpp); the row says they are complete.
struct Blob {
  std::string sha256;  ///< 64 lower-case hex digits of the bytes as uploaded
  std::int64_t bytes = 0;
  std::string format;       ///< `csv`, `npy`
  std::string compression;  ///< `none`, `gzip`, `xz`, `zstd`
  std::int64_t rows = 0;
  std::string columns_json = "[]";  ///< names in file order
  std::string notes_json = "[]";
  UtcMicros created_at = 0;
};

/// One (device, blob) with its meaning. Other metadata for the same pair is a conflict; PATCH makes a revision.
struct Recording {
  std::string id;  ///< `rec_...`
  std::string device_id;
  std::string blob_sha256;
  std::int64_t revision = 1;
  std::string metadata_json;  ///< canonical text of one member of `recordings` in spec/study.md, without `file`
  std::string condition;      ///< compact text form, see core/signal/condition.hpp
  std::string quality_json = "{}";
  UtcMicros created_at = 0;
  UtcMicros updated_at = 0;
  std::string tags_json = "{}";  ///< canonical text of labels, session and recorded_at; no result depends on them
  std::int64_t tags_revision = 0;
  std::string file_name = {};   ///< of the file that was uploaded, as its sender called it; may be empty
  std::string name = {};        ///< read only: `id` of the metadata, else the name of the file
  std::string latest_job = {};  ///< read only: the newest job whose request names the recording; empty: none does
};

/// The label that regression runs of a device compare with, from then on.
struct Anchor {
  std::string id;  ///< `anc_...`
  std::string device_id;
  std::string label;  ///< `firmware=1.4.2`
  std::string reason;
  UtcMicros created_at = 0;
  std::string settings_json = {};  ///< margins, scope and alpha that go with it; empty: none were kept
};

/// A text or a figure that a job made of its result.
struct Artefact {
  std::string name;
  std::string content;
};

enum class JobState { Queued, Running, Succeeded, Failed, Cancelled, Dead };

/// The state as documents and rows write it: `queued`, `running`, ...
[[nodiscard]] std::string_view name_of(JobState state);
[[nodiscard]] std::optional<JobState> parse_job_state(std::string_view name);
/// True for the four states that a job never leaves.
[[nodiscard]] bool is_terminal(JobState state);

struct Job {
  std::string id;    ///< `job_...`
  std::string kind;  ///< `characterise`
  JobState state = JobState::Queued;
  std::string stage;         ///< what the worker is doing: "decode", "fit WN+GM"; empty before the first report
  double progress = 0.0;     ///< 0 to 1
  int priority = 5;          ///< 0 (first) to 9
  std::int64_t attempt = 0;  ///< fencing number: grows with every claim
  int failures = 0;          ///< attempts that count towards `max_failures`
  int max_failures = 5;
  std::string unique_key;    ///< SHA-256 of canonical {kind, inputs, parameters, seed, algorithm_version}
  std::string request_json;  ///< that canonical document
  bool cancel_requested = false;
  UtcMicros run_at = 0;  ///< not claimed before
  std::optional<UtcMicros> lease_expires_at;
  UtcMicros created_at = 0;
  std::optional<UtcMicros> started_at;   ///< of the latest attempt
  std::optional<UtcMicros> finished_at;  ///< set if and only if the state is terminal
  std::string problem_json;              ///< the problem document of the last failure; empty otherwise
  bool is_damaged = false;               ///< read only: the request, or what its end left, is not what was written
  std::string device_name;     ///< of the one device that its request names; empty: none, several, or not asked for
  std::string recording_name;  ///< the same of the one recording
  std::vector<std::string> attempt_problems_json;  ///< every failed attempt, oldest first (only filled by `job`)
};

/// One line of a job's history; `sequence` is the SSE id.
struct JobEvent {
  std::int64_t sequence = 0;
  std::string type;  ///< `state` or `progress`
  JobState state = JobState::Queued;
  std::string stage;
  double progress = 0.0;
  std::int64_t attempt = 0;
  UtcMicros at = 0;
};

/// What a list of devices shows of a channel's result.
struct Glance {
  std::string json = "null";  ///< null: there is nothing to show
  int level = 0;              ///< the higher, the more a person must read it
};

/// The glance of a stored result, by its document.
using GlanceOf = std::function<Glance(const std::string& document_json)>;

/// The characterisation of one channel as a job found it.
struct ChannelResult {
  std::string id;  ///< `chr_...`
  std::string job_id;
  std::string device_id;
  std::string recording_id;
  std::int64_t recording_revision = 1;
  std::string channel;  ///< the file's column name
  std::string quantity;
  std::string axis;
  std::string condition;      ///< compact text form
  std::string document_json;  ///< one member of `channels`, spec/results.md
  std::string settings_json;  ///< models, seed, algorithm version, instruction set
  UtcMicros created_at = 0;
  Glance glance = {};  ///< written only
};

/// One model fitted to one channel.
struct Fit {
  std::string id;  ///< `fit_...`
  std::string channel_result_id;
  std::string job_id;
  std::string device_id;
  std::string recording_id;
  std::int64_t recording_revision = 1;
  std::string channel;
  std::string quantity;
  std::string axis;
  std::string condition;
  std::string model;
  int rank = 0;               ///< 0 is the best by the criterion
  std::string document_json;  ///< one member of `fits`, spec/results.md
  UtcMicros created_at = 0;
};

/// One sensor axis of one device.
struct SensorAxis {
  std::string device_id;
  std::string quantity;
  std::string axis;
  bool operator==(const SensorAxis&) const = default;
};

/// One sensor axis as it stands, at one moment.
struct AxisResults {
  std::vector<ChannelResult> latest;  ///< as `latest_channel_results` gives them
  std::optional<Job> pool;            ///< what pools exactly these; none for fewer than two, and without a named axis
  std::string pooled_json = {};       ///< its result; empty until it has succeeded
};

/// What the job that pooled an axis made beside its result.
struct PooledArtefact {
  std::string job_id;
  std::string content;
};

/// What a result comes to.
struct ResultVerdict {
  std::string id = {};                ///< `att_...`
  std::string job_id = {};            ///< known once it is stored
  std::string kind = {};              ///< of the job; known once it is stored
  std::string device_id = {};         ///< empty: it speaks of no device, or of several
  std::string recording_id = {};      ///< empty: it speaks of the job's result as a whole
  std::string channel = {};           ///< that says most against itself; without a recording a model: of its devices
  std::string level = {};             ///< `fine`, or `look` or `wrong`: a person must read it
  std::string verdict = {};           ///< one sentence; empty, of a model: it says nothing any more of the device
  std::string investigation_id = {};  ///< read only: what the job made; empty: it is of another kind
  std::string device_name = {};       ///< read only
  UtcMicros created_at = 0;
};

/// A study as it was handed in: one device, some of its recordings.
struct Study {
  std::string id;  ///< `stu_...`
  std::string device_id;
  std::string unique_key;  ///< SHA-256 of the document
  std::string document_json;
  UtcMicros created_at = 0;
};

/// A drive document over recordings of one device. It never changes.
struct StoredDrive {
  std::string id;  ///< `drv_...`
  std::string device_id;
  std::string unique_key;  ///< SHA-256 of device and document
  std::string document_json;
  UtcMicros created_at = 0;
};

/// A calibration of a device's sensors. It never changes.
struct StoredCalibration {
  std::string id;  ///< `cal_...`
  std::string device_id;
  std::string unique_key;     ///< SHA-256 of device and document
  std::string document_json;  ///< `calibration`, and the recordings and settings it was made from
  UtcMicros created_at = 0;
};

/// A simulation model. It never changes: a changed one is a child.
struct Model {
  std::string id;          ///< `mod_...`
  std::string parent_id;   ///< empty: a first model
  std::string device_id;   ///< empty: of no device in particular
  std::string unique_key;  ///< one model per key
  std::string name;
  std::string document_json;    ///< `processes`, `deterministic`, `channels`, `effects`
  std::string provenance_json;  ///< where it came from; for a child what changed and why
  UtcMicros created_at = 0;
};

/// What was found wrong with a baseline. The report is the document of its job's result.
struct Investigation {
  std::string id;      ///< `inv_...`
  std::string job_id;  ///< known once it is stored
  std::string device_id;
  std::string study_id;
  std::string baseline_id;   ///< the model that was criticised
  std::string model_id;      ///< the extended one; the baseline where nothing was found
  std::string summary_json;  ///< findings in a few words, for lists
  std::string page;          ///< the report as Markdown
  UtcMicros created_at = 0;
};

/// Everything a finished job writes, in the transaction that finishes it.
struct JobResults {
  std::string document_json;  ///< the whole result, served as the job's result
  std::vector<ChannelResult> channels;
  std::vector<Fit> fits;
  /// The document is that of a pool job: where newer results came meanwhile the job ends cancelled and leaves nothing.
  bool pooled = false;
  std::vector<Model> models = {};  ///< parents before children
  std::vector<Investigation> investigations = {};
  std::vector<Artefact> artefacts = {};
  std::vector<ResultVerdict> verdicts = {};  ///< each of a recording replaces what was said of it before
};

/// A stored answer to a POST that carried an Idempotency-Key.
struct IdempotentReply {
  std::string key;
  std::string method;
  std::string target;
  std::string body_sha256;
  int status = 0;
  std::string headers_json;
  std::string body;
  UtcMicros created_at = 0;
};

}  // namespace driftlab::server
