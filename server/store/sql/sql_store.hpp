#pragma once
/// The store over the tables of this folder, for any engine that runs their transactions.
#include "server/store/access_store.hpp"
#include "server/store/checksums.hpp"
#include "server/store/sql/database.hpp"
#include "server/store/sql/sql_access.hpp"
#include "server/store/sql/sql_parts.hpp"
#include "server/store/sql/sql_webhooks.hpp"
#include "server/store/store.hpp"
#include "server/store/webhook_store.hpp"

#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <random>
#include <string>
#include <string_view>
#include <vector>

namespace driftlab::server {

/// Hands every method to a transaction of its database. The work itself is in the files named after resources.
class SqlStore : public Store {
 public:
  /// `jitter_seed` is that of the pauses before failed jobs are tried again. `audited` is told of every row of the
  /// audit log once it is durable, and may be empty.
  SqlStore(std::unique_ptr<Database> database, std::uint64_t jitter_seed, AuditListener audited);

  /// Tokens, sessions and the audit log. Lives as long as the store.
  [[nodiscard]] AccessStore& access() { return access_; }
  /// Webhooks and their deliveries. Lives as long as the store.
  [[nodiscard]] WebhookStore& webhooks() { return webhooks_; }
  [[nodiscard]] PartStore& parts() override { return parts_; }

  /// How long writes have taken since the start.
  [[nodiscard]] WriteTimes::Counts write_times() const { return database_->write_times(); }
  /// Pages of the write-ahead log; nothing where the database lies elsewhere.
  [[nodiscard]] std::optional<std::int64_t> log_pages() const { return database_->log_pages(); }
  /// Bytes of everything that was uploaded and is still there.
  [[nodiscard]] Result<std::int64_t> blob_bytes();

  /// For the start of a daemon: what results of an earlier release say at a glance. How many lacked it.
  [[nodiscard]] Result<int> keep_missing_glances(const GlanceOf& glance_of);

  /// Likewise: seals rows of an earlier release (server/store/sql/seals.hpp). How many lacked it.
  [[nodiscard]] Result<int> seal_unsealed_rows();
  /// Reads every sealed row back and tells of those whose seal does not fit, as `table/key`. `pace` waits between a few
  /// rows and the next. Errors: those of the database; Cancelled.
  [[nodiscard]] Status read_back_rows(const ReadingPace& pace,
                                      const std::function<void(const std::string& row)>& damaged);
  /// Whether one row, as `table/key`, is damaged as it now is; nothing where only read_back_rows can say it.
  [[nodiscard]] Result<std::optional<bool>> is_damaged(std::string_view row);
  /// `listener` is told of every row that a read finds damaged. To be called before others use the store.
  void tell_damage_to(DamageListener listener) { database_->tell_damage_to(std::move(listener)); }

  [[nodiscard]] Status ping() override;

  [[nodiscard]] std::uint64_t changes() const override;

  [[nodiscard]] Result<DeviceOutcome> ensure_device(const Device& device) override;
  [[nodiscard]] Result<Device> device(std::string_view id_or_name) override;
  [[nodiscard]] Result<std::vector<Device>> devices(const DeviceFilter& filter, const Page& page) override;
  [[nodiscard]] Result<Device> update_device(std::string_view id, const DeviceChange& change,
                                             std::int64_t expected_revision) override;

  [[nodiscard]] Result<std::optional<Blob>> blob(std::string_view sha256) override;
  [[nodiscard]] Result<RecordingOutcome> add_recording(const Blob& blob, const Recording& recording) override;
  [[nodiscard]] Status write_probe() override;
  [[nodiscard]] Result<DeviceUsage> usage_of(std::string_view device_id, std::string_view sha256) override;
  [[nodiscard]] Result<DeviceUsage> usage_of_token(std::string_view token, std::string_view sha256) override;
  [[nodiscard]] Result<int> forget_ended_jobs(UtcMicros before) override;
  [[nodiscard]] Result<Recording> recording(std::string_view id) override;
  [[nodiscard]] Result<std::vector<Recording>> recordings_of(const std::vector<std::string>& ids) override;
  [[nodiscard]] Result<std::vector<Recording>> recordings(const RecordingFilter& filter, const Page& page) override;
  [[nodiscard]] Result<Counts> counts(const std::optional<Visibility>& visible) override;
  [[nodiscard]] Result<EndedCounts> ended_since(UtcMicros since, const std::optional<Visibility>& visible) override;
  [[nodiscard]] Result<bool> sees_job(std::string_view job, const Visibility& visible) override;
  [[nodiscard]] Result<bool> is_owner(std::string_view object, std::string_view token) override;
  [[nodiscard]] Result<DeviceOverviews> overviews(const std::vector<std::string>& device_ids,
                                                  const std::optional<Visibility>& visible) override;
  [[nodiscard]] Result<Recording> revise_recording(const Recording& recording, std::int64_t expected_revision) override;
  [[nodiscard]] Status remove_recording(std::string_view id, std::int64_t expected_revision) override;
  [[nodiscard]] Result<std::vector<StoredRecording>> stored_recordings(std::string_view after, int most) override;
  [[nodiscard]] Status expire_recording(std::string_view id) override;
  [[nodiscard]] Status remove_device(std::string_view id, std::int64_t expected_revision) override;
  [[nodiscard]] Status remove_study(std::string_view id) override;
  [[nodiscard]] Status remove_drive(std::string_view id) override;
  [[nodiscard]] Status remove_calibration(std::string_view id) override;
  [[nodiscard]] Status remove_model(std::string_view id) override;
  [[nodiscard]] Status remove_investigation(std::string_view id) override;
  [[nodiscard]] Result<std::vector<std::string>> blob_hashes() override;
  [[nodiscard]] Result<bool> remove_unused_blob(std::string_view sha256) override;

  [[nodiscard]] Result<EnqueuedJob> enqueue(const NewJob& job) override;
  [[nodiscard]] Result<Job> job(std::string_view id) override;
  [[nodiscard]] Result<std::vector<Job>> jobs(const JobFilter& filter, const Page& page) override;
  using Store::claim;
  [[nodiscard]] Result<std::optional<Job>> claim(std::int64_t lease_micros, std::int64_t running_per_token,
                                                 const std::vector<KnownKind>& known) override;
  [[nodiscard]] Result<LeaseStatus> renew(const Lease& lease, std::int64_t lease_micros) override;
  [[nodiscard]] Result<LeaseStatus> report_progress(const Lease& lease, std::string_view stage,
                                                    double progress) override;
  [[nodiscard]] Result<LeaseStatus> succeed(const Lease& lease, const JobResults& results) override;
  [[nodiscard]] Result<LeaseStatus> fail_attempt(const Lease& lease, const AttemptFailure& failure) override;
  [[nodiscard]] Result<LeaseStatus> acknowledge_cancel(const Lease& lease) override;
  [[nodiscard]] Result<LeaseStatus> release(const Lease& lease) override;
  [[nodiscard]] Result<Job> request_cancel(std::string_view id) override;
  [[nodiscard]] Result<int> rescue_expired() override;
  [[nodiscard]] Result<int> settle_recordings() override;
  [[nodiscard]] Result<int> end_all_leases() override;
  [[nodiscard]] Result<std::vector<JobEvent>> events_after(std::string_view job_id, std::int64_t sequence,
                                                           int limit) override;

  [[nodiscard]] Result<std::string> result_document(std::string_view job_id) override;
  [[nodiscard]] Result<Fit> fit(std::string_view id) override;
  [[nodiscard]] Result<std::vector<Fit>> fits(const FitFilter& filter, const Page& page) override;
  [[nodiscard]] Result<std::vector<ResultVerdict>> verdicts(const VerdictFilter& filter, const Page& page) override;
  [[nodiscard]] Result<std::vector<ChannelResult>> latest_channel_results(std::string_view device_id,
                                                                          std::string_view quantity,
                                                                          std::string_view axis) override;
  [[nodiscard]] Result<std::vector<std::string>> axes_with_results(std::string_view device_id,
                                                                   std::string_view quantity) override;
  [[nodiscard]] Result<AxisResults> axis_results(const SensorAxis& axis) override;
  [[nodiscard]] Result<std::optional<PooledArtefact>> pooled_artefact(const SensorAxis& axis,
                                                                      std::string_view name) override;
  [[nodiscard]] Result<int> queue_missing_pools() override;

  [[nodiscard]] Result<StudyOutcome> add_study(const Study& study) override;
  [[nodiscard]] Result<Study> study(std::string_view id) override;
  [[nodiscard]] Result<std::vector<Study>> studies(const std::optional<std::string>& device_id,
                                                   const Page& page) override;

  [[nodiscard]] Result<DriveOutcome> add_drive(const StoredDrive& drive) override;
  [[nodiscard]] Result<StoredDrive> drive(std::string_view id) override;
  [[nodiscard]] Result<std::vector<StoredDrive>> drives(const std::optional<std::string>& device_id,
                                                        const Page& page) override;

  [[nodiscard]] Result<CalibrationOutcome> add_calibration(const StoredCalibration& calibration) override;
  [[nodiscard]] Result<StoredCalibration> calibration(std::string_view id) override;
  [[nodiscard]] Result<std::vector<StoredCalibration>> calibrations(const std::optional<std::string>& device_id,
                                                                    const Page& page) override;

  [[nodiscard]] Result<ModelOutcome> add_model(const Model& model) override;
  [[nodiscard]] Result<Model> model(std::string_view id) override;
  [[nodiscard]] Result<std::vector<Model>> models(const ModelFilter& filter, const Page& page) override;
  [[nodiscard]] Result<Investigation> investigation(std::string_view id) override;
  [[nodiscard]] Result<std::vector<Investigation>> investigations(const InvestigationFilter& filter,
                                                                  const Page& page) override;

  [[nodiscard]] Result<Anchor> add_anchor(const Anchor& anchor) override;
  [[nodiscard]] Result<std::vector<Anchor>> anchors(const std::optional<std::string>& device_id,
                                                    const Page& page) override;
  [[nodiscard]] Result<std::string> artefact(std::string_view job_id, std::string_view name) override;

  [[nodiscard]] Result<std::optional<IdempotentReply>> idempotent_reply(std::string_view key) override;
  [[nodiscard]] Status remember_reply(const IdempotentReply& reply) override;
  [[nodiscard]] Result<int> forget_old_replies() override;

 protected:
  [[nodiscard]] Database& database() { return *database_; }

 private:
  [[nodiscard]] UtcMicros now(const Connection& connection) const { return database_->now(connection); }

  /// Runs what removes an object, and writes it into the audit log.
  template <class Work>
  [[nodiscard]] Status remove(const char* action, std::string_view id, const Work& work);

  std::unique_ptr<Database> database_;
  std::mutex jitter_mutex_;
  std::mt19937_64 jitter_;  ///< seeds the generator of each pause
  AuditedWriter audited_;
  SqlAccess access_;
  SqlWebhooks webhooks_;
  SqlParts parts_;
};

}  // namespace driftlab::server
