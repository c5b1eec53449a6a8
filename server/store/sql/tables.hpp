#pragma once
/// What each method of the store does inside a transaction: one source file per resource, with its SQL texts on top.
///
/// Functions take the connection of a running transaction; those that write take the time as `now`. Contracts are those
/// of the methods of the same name in server/store/store.hpp.
#include "core/signal/result.hpp"
#include "server/store/sql/connection.hpp"
#include "server/store/sql/filtered_query.hpp"
#include "server/store/sql/read_rows.hpp"
#include "server/store/sql/seals.hpp"
#include "server/store/store.hpp"

#include <cstdint>
#include <optional>
#include <random>
#include <string>
#include <string_view>
#include <vector>

namespace driftlab::server::tables {

// ---- devices
[[nodiscard]] Result<Store::DeviceOutcome> ensure_device(Connection& connection, const Device& device, UtcMicros now);
[[nodiscard]] Result<Device> device(Connection& connection, std::string_view id_or_name);
[[nodiscard]] Result<std::vector<Device>> devices(Connection& connection, const DeviceFilter& filter, const Page& page);
[[nodiscard]] Result<Device> update_device(Connection& connection, std::string_view id, const DeviceChange& change,
                                           std::int64_t expected_revision, UtcMicros now);

// ---- blobs and recordings
[[nodiscard]] Result<std::optional<Blob>> blob(Connection& connection, std::string_view sha256);
[[nodiscard]] Result<RecordingOutcome> add_recording(Connection& connection, const Blob& blob,
                                                     const Recording& recording, UtcMicros now);
[[nodiscard]] Result<DeviceUsage> usage_of(Connection& connection, std::string_view device_id, std::string_view sha256);
[[nodiscard]] Result<DeviceUsage> usage_of_token(Connection& connection, std::string_view token,
                                                 std::string_view sha256);
/// Bytes of all blobs, as uploaded.
[[nodiscard]] Result<std::int64_t> blob_bytes(Connection& connection);
[[nodiscard]] Result<Recording> recording(Connection& connection, std::string_view id);
[[nodiscard]] Result<std::vector<Recording>> recordings_of(Connection& connection, const std::vector<std::string>& ids);
[[nodiscard]] Result<std::vector<Recording>> recordings(Connection& connection, const RecordingFilter& filter,
                                                        const Page& page);
[[nodiscard]] Result<Counts> counts(Connection& connection, const std::optional<Visibility>& visible);
[[nodiscard]] Result<EndedCounts> ended_since(Connection& connection, UtcMicros since,
                                              const std::optional<Visibility>& visible);
[[nodiscard]] Result<DeviceOverviews> overviews(Connection& connection, const std::vector<std::string>& device_ids,
                                                const std::optional<Visibility>& visible);
[[nodiscard]] Result<int> settle_recordings(Connection& connection);
/// Adds up some of what changes have added to amounts (migration 0028); SQLite has one row of each. Whether there may
/// be more.
[[nodiscard]] Result<bool> settle_amounts(Connection& connection);
[[nodiscard]] Result<Recording> revise_recording(Connection& connection, const Recording& changed,
                                                 std::int64_t expected_revision, UtcMicros now);
[[nodiscard]] Status remove_recording(Connection& connection, std::string_view id, std::int64_t expected_revision,
                                      UtcMicros now);
[[nodiscard]] Result<std::vector<StoredRecording>> stored_recordings(Connection& connection, std::string_view after,
                                                                     int most);
[[nodiscard]] Status expire_recording(Connection& connection, std::string_view id, UtcMicros now);
[[nodiscard]] Result<std::vector<std::string>> blob_hashes(Connection& connection);
[[nodiscard]] Result<bool> remove_unused_blob(Connection& connection, std::string_view sha256);

// ---- jobs: asking and looking
[[nodiscard]] Result<EnqueuedJob> enqueue(Connection& connection, const NewJob& job, UtcMicros now);
/// Without its attempts, whether it is damaged or not.
[[nodiscard]] Result<Job> job(Connection& connection, std::string_view id);
/// With them, if it and they are what was written. Error: damaged_row.
[[nodiscard]] Result<Job> sound_job(Connection& connection, std::string_view id);
[[nodiscard]] Result<int> forget_ended_jobs(Connection& connection, UtcMicros before);
[[nodiscard]] Result<std::vector<Job>> jobs(Connection& connection, const JobFilter& filter, const Page& page);
[[nodiscard]] Result<std::vector<JobEvent>> events_after(Connection& connection, std::string_view job_id,
                                                         std::int64_t sequence, int limit);
/// Writes the job's present state into its history. `type`: "state" or "progress". A state that ends the job also
/// queues what webhooks are told of it (webhook_tables.hpp).
[[nodiscard]] Status add_event(Connection& connection, std::string_view job_id, std::string_view type, UtcMicros now);

// ---- jobs: working
[[nodiscard]] Result<std::optional<Job>> claim(Connection& connection, std::int64_t lease_micros,
                                               std::int64_t running_per_token, const std::vector<KnownKind>& known,
                                               UtcMicros now);
[[nodiscard]] Result<LeaseStatus> renew(Connection& connection, const Lease& lease, std::int64_t lease_micros,
                                        UtcMicros now);
[[nodiscard]] Result<LeaseStatus> report_progress(Connection& connection, const Lease& lease, std::string_view stage,
                                                  double progress, UtcMicros now);
[[nodiscard]] Result<LeaseStatus> succeed(Connection& connection, const Lease& lease, const JobResults& results,
                                          UtcMicros now);
[[nodiscard]] Result<LeaseStatus> fail_attempt(Connection& connection, const Lease& lease,
                                               const AttemptFailure& failure, std::mt19937_64& jitter, UtcMicros now);
[[nodiscard]] Result<LeaseStatus> acknowledge_cancel(Connection& connection, const Lease& lease, UtcMicros now);
[[nodiscard]] Result<LeaseStatus> release(Connection& connection, const Lease& lease, UtcMicros now);
[[nodiscard]] Result<Job> request_cancel(Connection& connection, std::string_view id, UtcMicros now);
/// Puts back every running job whose lease ends at `now` or before; with nothing for `deadline`: every running job.
[[nodiscard]] Result<int> end_leases(Connection& connection, std::optional<UtcMicros> deadline, UtcMicros now);

// ---- results
[[nodiscard]] Status insert_results(Connection& connection, std::string_view job_id, const JobResults& results,
                                    UtcMicros now);
[[nodiscard]] Result<std::string> result_document(Connection& connection, std::string_view job_id);
[[nodiscard]] Result<Fit> fit(Connection& connection, std::string_view id);
[[nodiscard]] Result<std::vector<Fit>> fits(Connection& connection, const FitFilter& filter, const Page& page);
[[nodiscard]] Result<std::vector<ChannelResult>> latest_channel_results(Connection& connection,
                                                                        std::string_view device_id,
                                                                        std::string_view quantity,
                                                                        std::string_view axis);
[[nodiscard]] Result<std::vector<std::string>> axes_with_results(Connection& connection, std::string_view device_id,
                                                                 std::string_view quantity);
/// The ids alone of the latest results of an axis.
[[nodiscard]] Result<std::vector<std::string>> latest_result_ids(Connection& connection, const SensorAxis& axis);

// ---- what results come to
[[nodiscard]] Result<std::vector<ResultVerdict>> verdicts(Connection& connection, const VerdictFilter& filter,
                                                          const Page& page);
/// The columns of a verdict, and one of them as it was read.
#define DRIFTLAB_VERDICT_COLUMNS                                                                                      \
  "id, job_id, (SELECT kind FROM jobs WHERE jobs.id = verdicts.job_id), coalesce(device_id, ''), "                    \
  "coalesce(recording_id, ''), channel, level, verdict, coalesce((SELECT investigations.id FROM investigations "      \
  "WHERE investigations.job_id = verdicts.job_id), ''), coalesce((SELECT devices.name FROM devices WHERE devices.id " \
  "= verdicts.device_id), ''), created_at, seal"
[[nodiscard]] Result<ResultVerdict> read_verdict(const Statement& row);
/// After the job's result document. What was said before of the recordings that they speak of is forgotten.
[[nodiscard]] Status insert_verdicts(Connection& connection, std::string_view job_id, const JobResults& results,
                                     UtcMicros now);

// ---- pooling of the results of an axis
/// Makes the row of each axis name its latest results: what pooled others is cancelled, a job for these queued. How
/// many were queued.
/// Marks the results that stand for these axes.
[[nodiscard]] Status show_results(Connection& connection, const std::vector<SensorAxis>& axes);
/// Glances of some results that lack theirs, and the marks of their axes. How many; 0: none lacks it.
[[nodiscard]] Result<int> keep_glances(Connection& connection, const GlanceOf& glance_of);
[[nodiscard]] Result<int> refresh_pools(Connection& connection, const std::vector<SensorAxis>& axes, UtcMicros now);
[[nodiscard]] Result<int> queue_missing_pools(Connection& connection, UtcMicros now);
/// Named axes that have results of one job, of one recording.
/// Axes of the recordings of a job's results, those without a name among them.
[[nodiscard]] Result<std::vector<SensorAxis>> axes_of_job(Connection& connection, std::string_view job_id);
[[nodiscard]] Result<std::vector<SensorAxis>> axes_of_recording(Connection& connection, std::string_view recording_id);
/// Whether the results that the job was to pool are still the latest of their axis.
[[nodiscard]] Result<bool> pools_latest(Connection& connection, std::string_view job_id);
[[nodiscard]] Result<AxisResults> axis_results(Connection& connection, const SensorAxis& axis);
[[nodiscard]] Result<std::optional<PooledArtefact>> pooled_artefact(Connection& connection, const SensorAxis& axis,
                                                                    std::string_view name);

// ---- studies
[[nodiscard]] Result<Store::StudyOutcome> add_study(Connection& connection, const Study& study, UtcMicros now);
[[nodiscard]] Result<Study> study(Connection& connection, std::string_view id);
[[nodiscard]] Result<std::vector<Study>> studies(Connection& connection, const std::optional<std::string>& device_id,
                                                 const Page& page);

// ---- drives
[[nodiscard]] Result<Store::DriveOutcome> add_drive(Connection& connection, const StoredDrive& drive, UtcMicros now);
[[nodiscard]] Result<StoredDrive> drive(Connection& connection, std::string_view id);
[[nodiscard]] Result<std::vector<StoredDrive>> drives(Connection& connection,
                                                      const std::optional<std::string>& device_id, const Page& page);

// ---- calibrations
[[nodiscard]] Result<Store::CalibrationOutcome> add_calibration(Connection& connection,
                                                                const StoredCalibration& calibration, UtcMicros now);
[[nodiscard]] Result<StoredCalibration> calibration(Connection& connection, std::string_view id);
[[nodiscard]] Result<std::vector<StoredCalibration>> calibrations(Connection& connection,
                                                                  const std::optional<std::string>& device_id,
                                                                  const Page& page);

// ---- models and investigations
[[nodiscard]] Result<Store::ModelOutcome> add_model(Connection& connection, const Model& model, UtcMicros now);
[[nodiscard]] Result<Model> model(Connection& connection, std::string_view id);
[[nodiscard]] Result<std::vector<Model>> models(Connection& connection, const ModelFilter& filter, const Page& page);
[[nodiscard]] Result<Investigation> investigation(Connection& connection, std::string_view id);
[[nodiscard]] Result<std::vector<Investigation>> investigations(Connection& connection,
                                                                const InvestigationFilter& filter, const Page& page);
/// After the job's result document.
[[nodiscard]] Status insert_investigations(Connection& connection, std::string_view job_id, const JobResults& results,
                                           UtcMicros now);

// ---- regression runs
[[nodiscard]] Result<Anchor> add_anchor(Connection& connection, const Anchor& anchor, UtcMicros now);
[[nodiscard]] Result<std::vector<Anchor>> anchors(Connection& connection, const std::optional<std::string>& device_id,
                                                  const Page& page);
/// After the job's result document.
[[nodiscard]] Status insert_artefacts(Connection& connection, std::string_view job_id, const JobResults& results);
[[nodiscard]] Result<std::string> artefact(Connection& connection, std::string_view job_id, std::string_view name);

// ---- removing what others may depend on
/// Refuses the removal of a recording that a study or a drive names. Error: Conflict, which names them.
[[nodiscard]] Status require_unnamed_recording(Connection& connection, std::string_view id);
[[nodiscard]] Status remove_device(Connection& connection, std::string_view id, std::int64_t expected_revision);
[[nodiscard]] Status remove_study(Connection& connection, std::string_view id);
[[nodiscard]] Status remove_drive(Connection& connection, std::string_view id);
[[nodiscard]] Status remove_calibration(Connection& connection, std::string_view id);
[[nodiscard]] Status remove_model(Connection& connection, std::string_view id);
[[nodiscard]] Status remove_investigation(Connection& connection, std::string_view id);

// ---- idempotency
[[nodiscard]] Result<std::optional<IdempotentReply>> idempotent_reply(Connection& connection, std::string_view key,
                                                                      UtcMicros now);
[[nodiscard]] Status remember_reply(Connection& connection, const IdempotentReply& reply, UtcMicros now);
[[nodiscard]] Result<int> forget_old_replies(Connection& connection, UtcMicros now);

}  // namespace driftlab::server::tables
