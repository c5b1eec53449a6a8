#include "server/store/sqlite/sqlite_store.hpp"

#include "server/store/files.hpp"
#include "server/store/sqlite/reader_pool.hpp"
#include "server/store/sqlite/sqlite_access.hpp"
#include "server/store/sqlite/tables.hpp"
#include "server/store/sqlite/writer.hpp"

#include <nlohmann/json.hpp>
#include <sqlite3.h>

#include <random>

namespace driftlab::server {
namespace {

std::optional<tables::AuditEntry> changed(const char* action, const std::string& id) {
  return tables::AuditEntry{action, id, ""};
}

/// Objects that are made once: a row of the audit log only where this was the time.
std::optional<tables::AuditEntry> made(const char* action, bool created, const std::string& id) {
  return created ? changed(action, id) : std::nullopt;
}

/// A caller limited to devices may ask for no job that names another one; who asks is remembered.
Status note_caller(Connection& connection, const Job& job, const Caller* caller) {
  if (caller == nullptr) {
    return {};
  }
  if (const auto& devices = caller->principal.devices) {
    const auto within = tables::is_job_within(connection, job.id, nlohmann::json(*devices).dump());
    if (!within) {
      return fail(within.error());
    }
    if (!*within) {
      return tl::unexpected(forbidden("The token is limited to devices that are not those of this job."));
    }
  }
  return tables::add_owner(connection, job.id, *caller);
}

/// Hands every method to a reader or to the writer. The work itself is in the files named after resources.
class OpenedStore final : public SqliteStore {
 public:
  OpenedStore(FileHandle lock, SqliteFacts facts, const Clock& clock, std::uint64_t jitter_seed,
              std::unique_ptr<Connection> writer, std::unique_ptr<ReaderPool> readers, AuditListener listener)
      : lock_(std::move(lock)),
        facts_(std::move(facts)),
        clock_(clock),
        jitter_(jitter_seed),
        writer_(std::move(writer)),
        readers_(std::move(readers)),
        audited_(writer_, clock_, std::move(listener)),
        access_(writer_, audited_, *readers_, clock_) {}

  [[nodiscard]] const SqliteFacts& facts() const override { return facts_; }
  [[nodiscard]] AccessStore& access() override { return access_; }
  [[nodiscard]] Status copy_to(const std::filesystem::path& target) override {
    return readers_->borrow([&](Connection& c) { return copy_database(c, target); });
  }
  [[nodiscard]] Status ping() override {
    return readers_->read([](Connection& c) -> Status {
      const auto one = c.query_integer("SELECT 1 FROM schema_migrations LIMIT 1");
      return one ? Status{} : fail(one.error());
    });
  }

  [[nodiscard]] Result<DeviceOutcome> ensure_device(const Device& device) override {
    return audited_.write([&](Connection& c) { return tables::ensure_device(c, device, now()); },
                          [](const DeviceOutcome& o) { return made("device.create", o.created, o.device.id); });
  }
  [[nodiscard]] Result<Device> device(std::string_view id_or_name) override {
    return readers_->read([&](Connection& c) { return tables::device(c, id_or_name); });
  }
  [[nodiscard]] Result<std::vector<Device>> devices(const Page& page) override {
    return readers_->read([&](Connection& c) { return tables::devices(c, page); });
  }
  [[nodiscard]] Result<Device> update_device(std::string_view id, const DeviceChange& change,
                                             std::int64_t expected_revision) override {
    return audited_.write([&](Connection& c) { return tables::update_device(c, id, change, expected_revision, now()); },
                          [](const Device& device) { return changed("device.change", device.id); });
  }

  [[nodiscard]] Result<std::optional<Blob>> blob(std::string_view sha256) override {
    return readers_->read([&](Connection& c) { return tables::blob(c, sha256); });
  }
  [[nodiscard]] Result<RecordingOutcome> add_recording(const Blob& blob, const Recording& recording) override {
    return audited_.write([&](Connection& c) { return tables::add_recording(c, blob, recording, now()); },
                          [](const RecordingOutcome& o) { return made("recording.add", o.created, o.recording.id); });
  }
  [[nodiscard]] Status write_probe() override {
    // The value stays; the page goes through log and disk like any other.
    return writer_.write([](Connection& c) -> Status {
      return c.prepare("UPDATE schema_migrations SET applied_at = applied_at WHERE number = 1").run();
    });
  }
  [[nodiscard]] Result<DeviceUsage> usage_of(std::string_view device_id, std::string_view sha256) override {
    return readers_->read([&](Connection& c) { return tables::usage_of(c, device_id, sha256); });
  }
  [[nodiscard]] Result<int> forget_ended_jobs(UtcMicros before) override {
    return writer_.write([&](Connection& c) { return tables::forget_ended_jobs(c, before); });
  }
  [[nodiscard]] Result<Recording> recording(std::string_view id) override {
    return readers_->read([&](Connection& c) { return tables::recording(c, id); });
  }
  [[nodiscard]] Result<std::vector<Recording>> recordings(const RecordingFilter& filter, const Page& page) override {
    return readers_->read([&](Connection& c) { return tables::recordings(c, filter, page); });
  }
  [[nodiscard]] Result<Counts> counts(const std::optional<Visibility>& visible) override {
    return readers_->read([&](Connection& c) { return tables::counts(c, visible); });
  }
  [[nodiscard]] Result<bool> sees_job(std::string_view job, const Visibility& visible) override {
    return readers_->read([&](Connection& c) { return tables::sees_job(c, job, visible); });
  }
  [[nodiscard]] Result<bool> is_owner(std::string_view object, std::string_view token) override {
    return readers_->read([&](Connection& c) { return tables::is_owner(c, object, token); });
  }
  [[nodiscard]] Result<std::vector<ConditionCount>> conditions_of(std::string_view device_id) override {
    return readers_->read([&](Connection& c) { return tables::conditions_of(c, device_id); });
  }
  [[nodiscard]] Result<Recording> revise_recording(const Recording& recording,
                                                   std::int64_t expected_revision) override {
    return audited_.write(
        [&](Connection& c) { return tables::revise_recording(c, recording, expected_revision, now()); },
        [](const Recording& revised) { return changed("recording.change", revised.id); });
  }
  [[nodiscard]] Status remove_recording(std::string_view id, std::int64_t expected_revision) override {
    const auto removed = audited_.write(
        [&](Connection& c) {
          Status status = tables::remove_recording(c, id, expected_revision, now());
          return status ? Result<std::string>(std::string(id)) : fail(status.error());
        },
        [](const std::string& gone) { return changed("recording.delete", gone); });
    return removed ? Status{} : fail(removed.error());
  }
  [[nodiscard]] Result<std::vector<std::string>> blob_hashes() override {
    return readers_->read([](Connection& c) { return tables::blob_hashes(c); });
  }
  [[nodiscard]] Result<bool> remove_unused_blob(std::string_view sha256) override {
    return writer_.write([&](Connection& c) { return tables::remove_unused_blob(c, sha256); });
  }

  [[nodiscard]] Result<EnqueuedJob> enqueue(const NewJob& job) override {
    const Caller* const caller = caller_of_thread();
    return audited_.write(
        [&](Connection& c) -> Result<EnqueuedJob> {
          auto queued = tables::enqueue(c, job, now());
          if (queued) {
            if (Status noted = note_caller(c, queued->job, caller); !noted) {
              return fail(noted.error());
            }
          }
          return queued;
        },
        [](const EnqueuedJob& queued) { return made("job.create", queued.created, queued.job.id); });
  }
  [[nodiscard]] Result<Job> job(std::string_view id) override {
    return readers_->read([&](Connection& c) { return tables::job(c, id); });
  }
  [[nodiscard]] Result<std::vector<Job>> jobs(const JobFilter& filter, const Page& page) override {
    return readers_->read([&](Connection& c) { return tables::jobs(c, filter, page); });
  }
  [[nodiscard]] Result<std::optional<Job>> claim(std::int64_t lease_micros) override {
    return writer_.write([&](Connection& c) { return tables::claim(c, lease_micros, now()); });
  }
  [[nodiscard]] Result<LeaseStatus> renew(const Lease& lease, std::int64_t lease_micros) override {
    return writer_.write([&](Connection& c) { return tables::renew(c, lease, lease_micros, now()); });
  }
  [[nodiscard]] Result<LeaseStatus> report_progress(const Lease& lease, std::string_view stage,
                                                    double progress) override {
    return writer_.write([&](Connection& c) { return tables::report_progress(c, lease, stage, progress, now()); });
  }
  [[nodiscard]] Result<LeaseStatus> succeed(const Lease& lease, const JobResults& results) override {
    return writer_.write([&](Connection& c) { return tables::succeed(c, lease, results, now()); });
  }
  [[nodiscard]] Result<LeaseStatus> fail_attempt(const Lease& lease, const AttemptFailure& failure) override {
    return writer_.write([&](Connection& c) { return tables::fail_attempt(c, lease, failure, jitter_, now()); });
  }
  [[nodiscard]] Result<LeaseStatus> acknowledge_cancel(const Lease& lease) override {
    return writer_.write([&](Connection& c) { return tables::acknowledge_cancel(c, lease, now()); });
  }
  [[nodiscard]] Result<LeaseStatus> release(const Lease& lease) override {
    return writer_.write([&](Connection& c) { return tables::release(c, lease, now()); });
  }
  [[nodiscard]] Result<Job> request_cancel(std::string_view id) override {
    return audited_.write([&](Connection& c) { return tables::request_cancel(c, id, now()); },
                          [](const Job& job) { return changed("job.cancel", job.id); });
  }
  [[nodiscard]] Result<int> rescue_expired() override {
    return writer_.write([&](Connection& c) {
      const UtcMicros time = now();
      return tables::end_leases(c, time, time);
    });
  }
  [[nodiscard]] Result<int> end_all_leases() override {
    return writer_.write([&](Connection& c) { return tables::end_leases(c, std::nullopt, now()); });
  }
  [[nodiscard]] Result<std::vector<JobEvent>> events_after(std::string_view job_id, std::int64_t sequence,
                                                           int limit) override {
    return readers_->read([&](Connection& c) { return tables::events_after(c, job_id, sequence, limit); });
  }

  [[nodiscard]] Result<std::string> result_document(std::string_view job_id) override {
    return readers_->read([&](Connection& c) { return tables::result_document(c, job_id); });
  }
  [[nodiscard]] Result<Fit> fit(std::string_view id) override {
    return readers_->read([&](Connection& c) { return tables::fit(c, id); });
  }
  [[nodiscard]] Result<std::vector<Fit>> fits(const FitFilter& filter, const Page& page) override {
    return readers_->read([&](Connection& c) { return tables::fits(c, filter, page); });
  }
  [[nodiscard]] Result<std::vector<ChannelResult>> latest_channel_results(std::string_view device_id,
                                                                          std::string_view quantity,
                                                                          std::string_view axis) override {
    return readers_->read([&](Connection& c) { return tables::latest_channel_results(c, device_id, quantity, axis); });
  }
  [[nodiscard]] Result<AxisResults> axis_results(const SensorAxis& axis) override {
    return readers_->read([&](Connection& c) { return tables::axis_results(c, axis); });
  }
  [[nodiscard]] Result<int> queue_missing_pools() override {
    return writer_.write([&](Connection& c) { return tables::queue_missing_pools(c, now()); });
  }

  [[nodiscard]] Result<StudyOutcome> add_study(const Study& study) override {
    return audited_.write([&](Connection& c) { return tables::add_study(c, study, now()); },
                          [](const StudyOutcome& o) { return made("study.create", o.created, o.study.id); });
  }
  [[nodiscard]] Result<Study> study(std::string_view id) override {
    return readers_->read([&](Connection& c) { return tables::study(c, id); });
  }
  [[nodiscard]] Result<std::vector<Study>> studies(const std::optional<std::string>& device_id,
                                                   const Page& page) override {
    return readers_->read([&](Connection& c) { return tables::studies(c, device_id, page); });
  }

  [[nodiscard]] Result<CalibrationOutcome> add_calibration(const StoredCalibration& calibration) override {
    return audited_.write(
        [&](Connection& c) { return tables::add_calibration(c, calibration, now()); },
        [](const CalibrationOutcome& o) { return made("calibration.create", o.created, o.calibration.id); });
  }
  [[nodiscard]] Result<StoredCalibration> calibration(std::string_view id) override {
    return readers_->read([&](Connection& c) { return tables::calibration(c, id); });
  }
  [[nodiscard]] Result<std::vector<StoredCalibration>> calibrations(const std::optional<std::string>& device_id,
                                                                    const Page& page) override {
    return readers_->read([&](Connection& c) { return tables::calibrations(c, device_id, page); });
  }

  [[nodiscard]] Result<ModelOutcome> add_model(const Model& model) override {
    const Caller* const caller = caller_of_thread();
    return audited_.write(
        [&](Connection& c) -> Result<ModelOutcome> {
          auto added = tables::add_model(c, model, now());
          if (added && caller != nullptr) {
            if (Status noted = tables::add_owner(c, added->model.id, *caller); !noted) {
              return fail(noted.error());
            }
          }
          return added;
        },
        [](const ModelOutcome& o) { return made("model.create", o.created, o.model.id); });
  }
  [[nodiscard]] Result<Model> model(std::string_view id) override {
    return readers_->read([&](Connection& c) { return tables::model(c, id); });
  }
  [[nodiscard]] Result<std::vector<Model>> models(const ModelFilter& filter, const Page& page) override {
    return readers_->read([&](Connection& c) { return tables::models(c, filter, page); });
  }
  [[nodiscard]] Result<Investigation> investigation(std::string_view id) override {
    return readers_->read([&](Connection& c) { return tables::investigation(c, id); });
  }
  [[nodiscard]] Result<std::vector<Investigation>> investigations(const InvestigationFilter& filter,
                                                                  const Page& page) override {
    return readers_->read([&](Connection& c) { return tables::investigations(c, filter, page); });
  }

  [[nodiscard]] Result<std::optional<IdempotentReply>> idempotent_reply(std::string_view key) override {
    return readers_->read([&](Connection& c) { return tables::idempotent_reply(c, key, now()); });
  }
  [[nodiscard]] Status remember_reply(const IdempotentReply& reply) override {
    return writer_.write([&](Connection& c) { return tables::remember_reply(c, reply, now()); });
  }
  [[nodiscard]] Result<int> forget_old_replies() override {
    return writer_.write([&](Connection& c) { return tables::forget_old_replies(c, now()); });
  }

 private:
  [[nodiscard]] UtcMicros now() const { return clock_.now(); }

  // Destroyed from below: readers first, so that the writer's connection is the last and empties the log; then the
  // lock.
  FileHandle lock_;
  SqliteFacts facts_;
  const Clock& clock_;
  std::mt19937_64 jitter_;  ///< used by the writing thread alone
  Writer writer_;
  std::unique_ptr<ReaderPool> readers_;
  AuditedWriter audited_;
  SqliteAccess access_;
};

/// 3.7.0 to 3.51.2: https://sqlite.org/wal.html
bool has_wal_reset_bug(int version_number) { return version_number >= 3'007'000 && version_number < 3'051'003; }

Status prepare_directory(const std::filesystem::path& directory) {
  if (Status made = make_directories(directory); !made) {
    return made;
  }
  return require_local_file_system(directory);
}

}  // namespace

Result<std::unique_ptr<SqliteStore>> open_sqlite_store(const std::filesystem::path& directory, const Clock& clock,
                                                       SqliteOptions options) {
  if (Status prepared = prepare_directory(directory); !prepared) {
    return fail(prepared.error());
  }
  Result<FileHandle> lock = lock_directory(directory, "store.lock");
  if (!lock) {
    return fail(lock.error());
  }
  SqliteFacts facts;
  facts.version = sqlite3_libversion();
  facts.wal_reset_bug_possible = has_wal_reset_bug(sqlite3_libversion_number());
  facts.database = directory / "driftlab.db";
  Result<std::unique_ptr<Connection>> writer = Connection::open(facts.database, Access::ReadWrite);
  if (!writer) {
    return fail(writer.error());
  }
  if (Status sound = check_integrity(**writer); !sound) {
    return fail(sound.error());
  }
  const auto& migrations = options.migrations ? *options.migrations : embedded_migrations();
  const Result<MigrationOutcome> migrated = migrate(**writer, migrations, directory / "backups", clock);
  if (!migrated) {
    return fail(migrated.error());
  }
  facts.schema_before = migrated->from;
  facts.schema = migrated->to;
  facts.backup = migrated->backup;
  if (options.max_pages > 0) {
    if (Status limited = (*writer)->execute("PRAGMA max_page_count=" + std::to_string(options.max_pages)); !limited) {
      return fail(limited.error());
    }
  }
  // The names of the database's files must survive power loss before anything is acknowledged.
  if (Status synced = sync_path(directory); !synced) {
    return fail(synced.error());
  }
  Result<std::unique_ptr<ReaderPool>> readers = ReaderPool::open(facts.database, options.readers);
  if (!readers) {
    return fail(readers.error());
  }
  const std::uint64_t seed = options.jitter_seed ? *options.jitter_seed : std::random_device{}();
  return std::make_unique<OpenedStore>(std::move(*lock), std::move(facts), clock, seed, std::move(*writer),
                                       std::move(*readers), std::move(options.audited));
}

}  // namespace driftlab::server
