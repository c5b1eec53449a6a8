#pragma once
/// The store: everything the daemon remembers, behind one interface.
///
/// One suite (tests/unit/store/store_suite.hpp) runs over every implementation: SQLite and PostgreSQL. Methods are
/// synchronous and thread safe; they may block on disk and are therefore called from pools, never from I/O threads. A
/// write that returned success survives power loss. Every method may fail with ErrorCode::Io or DiskFull; other errors
/// are named. Lists are keyset pages in order of id, which is that of making, or of name.
#include "core/signal/result.hpp"
#include "server/store/rows.hpp"

#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace driftlab::server {

/// The rows that a caller limited to devices may see: those of its devices, and those that it asked for itself.
struct Visibility {
  std::string devices_json;  ///< names, as a JSON list
  std::string token;
};

/// Devices, recordings and models have names; equal ones are in order of id.
enum class PageOrder { OldestFirst, NewestFirst, ByName };

struct Page {
  std::string after;  ///< the last id of the page before; empty: the first page
  int limit = 50;
  PageOrder order = PageOrder::OldestFirst;
  std::string after_name = {};                       ///< the name of that last row, where names order the list
  std::optional<Visibility> visible = std::nullopt;  ///< nothing: every row
};

/// How much there is.
struct Counts {
  std::int64_t devices = 0;
  std::int64_t recordings = 0;
  std::int64_t queued = 0;
  std::int64_t running = 0;
};

/// How many jobs ended from a moment on, without those that pool results.
struct EndedCounts {
  std::int64_t succeeded = 0;
  std::int64_t failed = 0;  ///< those given up among them
};

struct ConditionCount {
  std::string condition;  ///< compact text form
  std::int64_t recordings = 0;
};

/// The result that stands for its axis in a list of devices: of the latest result per recording and channel one at rest
/// before one in motion; of those at rest one of the highest level, so that the list does not hide it; else the first.
struct ShownResult {
  std::string quantity;
  std::string axis;
  std::string recording_id;
  std::string condition;
  std::string glance_json;
};

/// What a list of devices shows of one.
struct DeviceOverview {
  std::vector<ConditionCount> conditions = {};         ///< each once, in the order of their text
  std::vector<ShownResult> axes = {};                  ///< by quantity and axis
  std::optional<ResultVerdict> verdict = {};           ///< the newest
  std::optional<ChannelResult> newest = std::nullopt;  ///< the newest: its job, recording and time
};
using DeviceOverviews = std::map<std::string, DeviceOverview, std::less<>>;  ///< by id

/// What is kept for a device.
struct DeviceUsage {
  std::int64_t recordings = 0;
  std::int64_t bytes = 0;          ///< as uploaded
  bool holds_these_bytes = false;  ///< a recording of the device has the blob that was asked for
};

/// A recording by what can be told of it whether its row is damaged or not.
struct StoredRecording {
  std::string id;
  std::string device_id;
  std::string blob_sha256;
  UtcMicros created_at = 0;
};

struct DeviceFilter {
  std::optional<std::string> text = {};  ///< part of its name, model, imu, serial or id, in any case
};

struct RecordingFilter {
  std::optional<std::string> device_id;
  std::optional<std::string> condition;
  std::vector<std::string> labels = {};  ///< `name=value`; a recording has them all
  std::optional<std::string> text = {};  ///< part of its name, file, condition or id, in any case
  std::optional<UtcMicros> since = {};   ///< made at this time or later
  std::optional<bool> has_result = {};   ///< whether a job has characterised it
};

struct JobFilter {
  std::optional<std::string> kind;
  std::optional<JobState> state;
  std::optional<std::string> input_device = std::nullopt;  ///< id: `inputs.device` of the request
  std::optional<std::string> candidate = std::nullopt;     ///< label: `inputs.candidate.label` of the request
  std::optional<std::string> device_id = std::nullopt;     ///< the request names it, or something of it
  std::optional<std::string> scenario = std::nullopt;  ///< part of the name of the scenario or of the id, in any case
  std::optional<UtcMicros> since = std::nullopt;       ///< made at this time or later
};

/// For fits and channel results. Only the latest result per (recording, channel) is listed when `latest_only`.
struct FitFilter {
  std::optional<std::string> device_id;
  std::optional<std::string> recording_id;
  std::optional<std::string> job_id;
  std::optional<std::string> quantity;
  std::optional<std::string> axis;
  std::optional<std::string> model;
  std::optional<bool> best_only;
  bool latest_only = false;
};

struct ModelFilter {
  std::optional<std::string> device_id;
  std::optional<std::string> parent_id;
  std::optional<std::string> text = {};  ///< part of its name or id, in any case
};

struct InvestigationFilter {
  std::optional<std::string> device_id;
  std::optional<std::string> study_id;
  std::optional<std::string> job_id;
  std::optional<std::string> text = {};  ///< part of the device's name, of the id or of what was found, in any case
  std::optional<UtcMicros> since = {};   ///< made at this time or later
};

struct VerdictFilter {
  std::optional<std::string> device_id = {};
  std::optional<UtcMicros> since = {};  ///< made at this time or later
  bool to_read = true;                  ///< only those that a person must read
};

struct DeviceChange {
  std::optional<std::string> model, imu, serial, labels_json;
};

/// A kind of jobs that a process can run, with the version of its algorithm.
struct KnownKind {
  std::string name;
  int version = 0;
};

struct NewJob {
  std::string kind;
  std::string unique_key;
  std::string request_json;
  int priority = 5;
};

/// `created` is false where an equal job was queued, running or succeeded already; that one is returned.
struct EnqueuedJob {
  Job job;
  bool created = false;
};

struct RecordingOutcome {
  Recording recording;
  bool created = false;
};

/// A worker's claim on a job: every write carries both members, and the attempt number fences off a worker whose lease
/// was lost.
struct Lease {
  std::string job_id;
  std::int64_t attempt = 0;
};

struct LeaseStatus {
  bool held = false;  ///< false: another worker may have the job; stop and discard
  bool cancel_requested = false;
  bool dead = false;  ///< the job was given up with this attempt
};

/// How an attempt ended without a result.
struct AttemptFailure {
  std::string problem_json;
  bool retryable = false;     ///< I/O, memory: back to `queued` with backoff; else `failed` at once
  bool fault_signal = false;  ///< the job's own work raised SIGSEGV or the like: twice is `dead`
};

class PartStore;

class Store {
 public:
  Store() = default;
  Store(const Store&) = delete;
  Store& operator=(const Store&) = delete;
  virtual ~Store() = default;

  // ---- health
  /// Answers a trivial query. For /readyz.
  [[nodiscard]] virtual Status ping() = 0;
  /// A sentence about the schema of the store, where that is a newer program's beside which this one works; else empty.
  [[nodiscard]] virtual std::string newer_schema() const { return {}; }
  /// Writes a row and waits until it is on disk. For /readyz.
  [[nodiscard]] virtual Status write_probe() = 0;
  /// Of what is `visible`; nothing: of everything.
  [[nodiscard]] virtual Result<Counts> counts(const std::optional<Visibility>& visible = std::nullopt) = 0;
  /// Of the jobs that ended at this time or later; likewise.
  [[nodiscard]] virtual Result<EndedCounts> ended_since(UtcMicros since,
                                                        const std::optional<Visibility>& visible = std::nullopt) = 0;
  /// Whether a caller limited to devices may see a job: the caller asked for it, or the job names devices and only the
  /// caller's.
  [[nodiscard]] virtual Result<bool> sees_job(std::string_view job, const Visibility& visible) = 0;
  /// Whether that token asked for the object.
  [[nodiscard]] virtual Result<bool> is_owner(std::string_view object, std::string_view token) = 0;

  /// Grows with every write that changed a row, before whoever asked for the write is told that it is stored. Reads a
  /// number in memory.
  [[nodiscard]] virtual std::uint64_t changes() const = 0;

  // ---- devices
  /// The device of that name, created if absent. `created` tells.
  struct DeviceOutcome {
    Device device;
    bool created = false;
  };
  [[nodiscard]] virtual Result<DeviceOutcome> ensure_device(const Device& device) = 0;
  /// By `dev_` id or by name. NotFound.
  [[nodiscard]] virtual Result<Device> device(std::string_view id_or_name) = 0;
  [[nodiscard]] virtual Result<std::vector<Device>> devices(const DeviceFilter& filter, const Page& page) = 0;
  /// Changes what `change` holds if the revision is still `expected_revision`. NotFound; Conflict (field "revision").
  [[nodiscard]] virtual Result<Device> update_device(std::string_view id, const DeviceChange& change,
                                                     std::int64_t expected_revision) = 0;

  /// Removes a device on which nothing depends; jobs that have ended go with it. NotFound; Conflict (revision; what
  /// depends on it, in the sentence and in a field for each kind).
  [[nodiscard]] virtual Status remove_device(std::string_view id, std::int64_t expected_revision) = 0;

  // ---- blobs and recordings
  [[nodiscard]] virtual Result<std::optional<Blob>> blob(std::string_view sha256) = 0;
  /// Adds the blob row if absent and the recording of (device, blob) if absent, in one transaction. The same metadata
  /// again gives the existing recording; other metadata: Conflict, with field "recording_id".
  [[nodiscard]] virtual Result<RecordingOutcome> add_recording(const Blob& blob, const Recording& recording) = 0;
  /// Of the device of that id; all zero for one that is not there.
  [[nodiscard]] virtual Result<DeviceUsage> usage_of(std::string_view device_id, std::string_view sha256) = 0;
  /// Of the recordings that the token of that id has added and that are still there, for whatever device.
  [[nodiscard]] virtual Result<DeviceUsage> usage_of_token(std::string_view token, std::string_view sha256) = 0;
  [[nodiscard]] virtual Result<Recording> recording(std::string_view id) = 0;
  /// Those of the ids that are there, in no order, in one read.
  [[nodiscard]] virtual Result<std::vector<Recording>> recordings_of(const std::vector<std::string>& ids) = 0;
  [[nodiscard]] virtual Result<std::vector<Recording>> recordings(const RecordingFilter& filter, const Page& page) = 0;
  /// Takes some of the recordings that have a result by now off the list of those without one, so that the others are
  /// found soon, and adds up what changes have added to amounts that are kept. How many recordings.
  [[nodiscard]] virtual Result<int> settle_recordings() = 0;
  /// Of the devices of those ids that are there, at one moment: in one read of each table for all of them.
  [[nodiscard]] virtual Result<DeviceOverviews> overviews(const std::vector<std::string>& device_ids,
                                                          const std::optional<Visibility>& visible = std::nullopt) = 0;
  /// New metadata, one revision higher, if revision and tags are still those that were read. What its results took part
  /// in is pooled anew without them. New tags alone are no new revision, and results stay. NotFound; Conflict.
  [[nodiscard]] virtual Result<Recording> revise_recording(const Recording& recording,
                                                           std::int64_t expected_revision) = 0;
  /// Stands for every revision: of a damaged row nobody knows it.
  static constexpr std::int64_t kAnyRevision = -1;
  /// Removes a recording that no job is using and no study or drive names, or a damaged one; its results go with it,
  /// and what they took part in is pooled anew without them. NotFound; Conflict (revision; running job; what names it).
  [[nodiscard]] virtual Status remove_recording(std::string_view id, std::int64_t expected_revision) = 0;
  /// Those behind the id `after`, by id, damaged ones too: no seal is looked at. At most so many.
  [[nodiscard]] virtual Result<std::vector<StoredRecording>> stored_recordings(std::string_view after, int most) = 0;
  /// As remove_recording whatever its revision, damaged or not, by the daemon itself, for the recording is as old as it
  /// may be (`recording.expire` in the audit log). NotFound; Conflict (running job; what names it).
  [[nodiscard]] virtual Status expire_recording(std::string_view id) = 0;
  /// Hashes of all blob rows, for the sweeper.
  [[nodiscard]] virtual Result<std::vector<std::string>> blob_hashes() = 0;
  /// Removes a blob row that no recording names. True if removed.
  [[nodiscard]] virtual Result<bool> remove_unused_blob(std::string_view sha256) = 0;

  // ---- jobs (state machine: server/jobs/README.md)
  /// An equal job that has succeeded and is damaged is made anew.
  [[nodiscard]] virtual Result<EnqueuedJob> enqueue(const NewJob& job) = 0;
  [[nodiscard]] virtual Result<Job> job(std::string_view id) = 0;
  /// Damaged ones stand among the others with `is_damaged`, and nothing else of them is to be shown but their ids.
  [[nodiscard]] virtual Result<std::vector<Job>> jobs(const JobFilter& filter, const Page& page) = 0;
  /// The next runnable job by (priority with ageing, run_at, id), now `running` with a lease; nothing if none is due.
  /// One that tokens asked for waits while each of them has `running_per_token` jobs running. Daemons that claim from
  /// one PostgreSQL at the same moment may pass that by one each. A job of a kind that is not `known`, or of a later
  /// version, is left to the newer program that works beside this one; nothing known: every job is taken.
  [[nodiscard]] virtual Result<std::optional<Job>> claim(std::int64_t lease_micros, std::int64_t running_per_token,
                                                         const std::vector<KnownKind>& known) = 0;
  [[nodiscard]] Result<std::optional<Job>> claim(
      std::int64_t lease_micros, std::int64_t running_per_token = std::numeric_limits<std::int64_t>::max()) {
    return claim(lease_micros, running_per_token, {});
  }
  [[nodiscard]] virtual Result<LeaseStatus> renew(const Lease& lease, std::int64_t lease_micros) = 0;
  [[nodiscard]] virtual Result<LeaseStatus> report_progress(const Lease& lease, std::string_view stage,
                                                            double progress) = 0;
  /// Results and the finish in one transaction, which also queues the pooling of every axis that has new results.
  /// `held` false: lease lost, nothing was written.
  [[nodiscard]] virtual Result<LeaseStatus> succeed(const Lease& lease, const JobResults& results) = 0;
  [[nodiscard]] virtual Result<LeaseStatus> fail_attempt(const Lease& lease, const AttemptFailure& failure) = 0;
  /// The worker of a job whose cancellation was requested has stopped.
  [[nodiscard]] virtual Result<LeaseStatus> acknowledge_cancel(const Lease& lease) = 0;
  /// Hands a job back unfinished (graceful stop); does not count as a failure.
  [[nodiscard]] virtual Result<LeaseStatus> release(const Lease& lease) = 0;
  /// queued -> cancelled at once; running -> flag; terminal -> unchanged. NotFound.
  [[nodiscard]] virtual Result<Job> request_cancel(std::string_view id) = 0;
  /// Jobs whose lease has expired go back to `queued`, without counting as failures. How many.
  [[nodiscard]] virtual Result<int> rescue_expired() = 0;
  /// Ends every lease, for the start of a daemon that owns the store alone. How many.
  [[nodiscard]] virtual Result<int> end_all_leases() = 0;
  [[nodiscard]] virtual Result<std::vector<JobEvent>> events_after(std::string_view job_id, std::int64_t sequence,
                                                                   int limit) = 0;

  /// The parts of running jobs. Belongs to this store.
  [[nodiscard]] virtual PartStore& parts() = 0;

  // ---- results
  [[nodiscard]] virtual Result<std::string> result_document(std::string_view job_id) = 0;
  [[nodiscard]] virtual Result<Fit> fit(std::string_view id) = 0;
  [[nodiscard]] virtual Result<std::vector<Fit>> fits(const FitFilter& filter, const Page& page) = 0;
  /// What results come to: of the newest characterisation of each recording, and of every other job.
  [[nodiscard]] virtual Result<std::vector<ResultVerdict>> verdicts(const VerdictFilter& filter, const Page& page) = 0;
  /// The latest result per (recording, channel) of the recording's current revision, by condition, content of the
  /// recording (its blob's hash) and channel: the same order however and whenever the recordings came.
  [[nodiscard]] virtual Result<std::vector<ChannelResult>> latest_channel_results(std::string_view device_id,
                                                                                  std::string_view quantity,
                                                                                  std::string_view axis) = 0;
  /// The axes about which such results are, in order; channels without an axis are not asked for.
  [[nodiscard]] virtual Result<std::vector<std::string>> axes_with_results(std::string_view device_id,
                                                                           std::string_view quantity) = 0;
  /// The latest results of an axis with what pools them.
  [[nodiscard]] virtual Result<AxisResults> axis_results(const SensorAxis& axis) = 0;
  /// The artefact of that name of the job that has pooled exactly the latest results; nothing where none has, or where
  /// it made none.
  [[nodiscard]] virtual Result<std::optional<PooledArtefact>> pooled_artefact(const SensorAxis& axis,
                                                                              std::string_view name) = 0;
  /// Queues the pooling of every axis whose latest results no job pools yet, for the start of a daemon: an earlier
  /// release may have pooled otherwise. How many.
  [[nodiscard]] virtual Result<int> queue_missing_pools() = 0;

  // ---- studies
  struct StudyOutcome {
    Study study;
    bool created = false;
  };
  /// The study of that unique key, added if absent.
  [[nodiscard]] virtual Result<StudyOutcome> add_study(const Study& study) = 0;
  [[nodiscard]] virtual Result<Study> study(std::string_view id) = 0;
  [[nodiscard]] virtual Result<std::vector<Study>> studies(const std::optional<std::string>& device_id,
                                                           const Page& page) = 0;

  /// Removes a study that has no investigation. NotFound; Conflict, as of a device.
  [[nodiscard]] virtual Status remove_study(std::string_view id) = 0;

  // ---- drives
  struct DriveOutcome {
    StoredDrive drive;
    bool created = false;
  };
  /// The drive of that unique key, added if absent.
  [[nodiscard]] virtual Result<DriveOutcome> add_drive(const StoredDrive& drive) = 0;
  [[nodiscard]] virtual Result<StoredDrive> drive(std::string_view id) = 0;
  [[nodiscard]] virtual Result<std::vector<StoredDrive>> drives(const std::optional<std::string>& device_id,
                                                                const Page& page) = 0;

  /// Removes a drive that no job is at work on; evaluations that have ended stay, with what they found. NotFound;
  /// Conflict, as of a device.
  [[nodiscard]] virtual Status remove_drive(std::string_view id) = 0;

  // ---- calibrations
  struct CalibrationOutcome {
    StoredCalibration calibration;
    bool created = false;
  };
  /// The calibration of that unique key, added if absent.
  [[nodiscard]] virtual Result<CalibrationOutcome> add_calibration(const StoredCalibration& calibration) = 0;
  [[nodiscard]] virtual Result<StoredCalibration> calibration(std::string_view id) = 0;
  [[nodiscard]] virtual Result<std::vector<StoredCalibration>> calibrations(const std::optional<std::string>& device_id,
                                                                            const Page& page) = 0;

  /// Removes a calibration that no recording and no study names. NotFound; Conflict, as of a device.
  [[nodiscard]] virtual Status remove_calibration(std::string_view id) = 0;

  // ---- models and investigations (written by `succeed`; models also by people)
  struct ModelOutcome {
    Model model;
    bool created = false;
  };
  /// The model of that unique key, added if absent. NotFound (field "parent", "device").
  [[nodiscard]] virtual Result<ModelOutcome> add_model(const Model& model) = 0;
  [[nodiscard]] virtual Result<Model> model(std::string_view id) = 0;
  [[nodiscard]] virtual Result<std::vector<Model>> models(const ModelFilter& filter, const Page& page) = 0;
  [[nodiscard]] virtual Result<Investigation> investigation(std::string_view id) = 0;
  [[nodiscard]] virtual Result<std::vector<Investigation>> investigations(const InvestigationFilter& filter,
                                                                          const Page& page) = 0;

  /// Removes a model that has no child and that no investigation began or ended with. NotFound; Conflict, as of a
  /// device.
  [[nodiscard]] virtual Status remove_model(std::string_view id) = 0;
  /// Removes an investigation with its job; the models that it made stay. NotFound.
  [[nodiscard]] virtual Status remove_investigation(std::string_view id) = 0;

  // ---- regression runs
  [[nodiscard]] virtual Result<Anchor> add_anchor(const Anchor& anchor) = 0;
  [[nodiscard]] virtual Result<std::vector<Anchor>> anchors(const std::optional<std::string>& device_id,
                                                            const Page& page) = 0;
  /// What a job made of its result under that name. NotFound.
  [[nodiscard]] virtual Result<std::string> artefact(std::string_view job_id, std::string_view name) = 0;

  // ---- idempotency
  /// The stored reply for a key younger than 24 h.
  [[nodiscard]] virtual Result<std::optional<IdempotentReply>> idempotent_reply(std::string_view key) = 0;
  [[nodiscard]] virtual Status remember_reply(const IdempotentReply& reply) = 0;
  /// Removes replies older than 24 h. How many.
  [[nodiscard]] virtual Result<int> forget_old_replies() = 0;

  // ---- retention
  /// Removes jobs that failed, were cancelled or given up and ended before that time. How many.
  [[nodiscard]] virtual Result<int> forget_ended_jobs(UtcMicros before) = 0;
};

}  // namespace driftlab::server
