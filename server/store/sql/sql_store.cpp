#include "server/store/sql/sql_store.hpp"

#include "server/store/sql/tables.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>

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

}  // namespace

SqlStore::SqlStore(std::unique_ptr<Database> database, std::uint64_t jitter_seed, AuditListener audited)
    : database_(std::move(database)),
      jitter_(jitter_seed),
      audited_(*database_, std::move(audited)),
      access_(*database_, audited_),
      webhooks_(*database_, audited_),
      parts_(*database_) {}

template <class Work>
Status SqlStore::remove(const char* action, std::string_view id, const Work& work) {
  const auto removed = audited_.write(
      [&](Connection& c) {
        Status status = work(c);
        return status ? Result<std::string>(std::string(id)) : fail(status.error());
      },
      [action](const std::string& gone) { return changed(action, gone); });
  return removed ? Status{} : fail(removed.error());
}

Status SqlStore::ping() {
  return database_->read([](Connection& c) -> Status {
    const auto one = c.query_integer("SELECT 1 FROM schema_migrations LIMIT 1");
    return one ? Status{} : fail(one.error());
  });
}

std::uint64_t SqlStore::changes() const { return database_->changes(); }

Result<Store::DeviceOutcome> SqlStore::ensure_device(const Device& device) {
  return audited_.write([&](Connection& c) { return tables::ensure_device(c, device, now(c)); },
                        [](const DeviceOutcome& o) { return made("device.create", o.created, o.device.id); });
}

Result<Device> SqlStore::device(std::string_view id_or_name) {
  return database_->read([&](Connection& c) { return tables::device(c, id_or_name); });
}

Result<std::vector<Device>> SqlStore::devices(const DeviceFilter& filter, const Page& page) {
  return database_->read([&](Connection& c) { return tables::devices(c, filter, page); });
}

Result<Device> SqlStore::update_device(std::string_view id, const DeviceChange& change,
                                       std::int64_t expected_revision) {
  return audited_.write([&](Connection& c) { return tables::update_device(c, id, change, expected_revision, now(c)); },
                        [](const Device& device) { return changed("device.change", device.id); });
}

Result<std::optional<Blob>> SqlStore::blob(std::string_view sha256) {
  return database_->read([&](Connection& c) { return tables::blob(c, sha256); });
}

Result<RecordingOutcome> SqlStore::add_recording(const Blob& blob, const Recording& recording) {
  const Caller* const caller = caller_of_thread();
  return audited_.write(
      [&](Connection& c) {
        auto added = tables::add_recording(c, blob, recording, now(c));
        if (added && added->created && caller != nullptr) {
          if (Status noted = tables::add_owner(c, added->recording.id, *caller); !noted) {
            added = fail(noted.error());
          }
        }
        return added;
      },
      [](const RecordingOutcome& o) { return made("recording.add", o.created, o.recording.id); });
}

Status SqlStore::write_probe() {
  // A row that comes and goes: SQLite does not write a row that stays what it is. No client's key has a space in it.
  return database_->write(WriteKind::Fenced, [](Connection& c) -> Status {
    const Status written =
        c.prepare(
             "INSERT INTO idempotent_replies (key, method, target, body_sha256, status, headers_json, "
             "body, created_at) VALUES ('write probe', '', '', '', 0, '', '', 0) "
             "ON CONFLICT (key) DO NOTHING")
            .run();
    return written ? c.prepare("DELETE FROM idempotent_replies WHERE key = 'write probe'").run() : written;
  });
}

Result<DeviceUsage> SqlStore::usage_of(std::string_view device_id, std::string_view sha256) {
  return database_->read([&](Connection& c) { return tables::usage_of(c, device_id, sha256); });
}

Result<DeviceUsage> SqlStore::usage_of_token(std::string_view token, std::string_view sha256) {
  return database_->read([&](Connection& c) { return tables::usage_of_token(c, token, sha256); });
}

Result<std::int64_t> SqlStore::blob_bytes() {
  return database_->read([](Connection& c) { return tables::blob_bytes(c); });
}

Result<int> SqlStore::forget_ended_jobs(UtcMicros before) {
  return database_->write(WriteKind::Serial, [&](Connection& c) { return tables::forget_ended_jobs(c, before); });
}

Result<Recording> SqlStore::recording(std::string_view id) {
  return database_->read([&](Connection& c) { return tables::recording(c, id); });
}

Result<std::vector<Recording>> SqlStore::recordings_of(const std::vector<std::string>& ids) {
  return database_->read([&](Connection& c) { return tables::recordings_of(c, ids); });
}

Result<std::vector<Recording>> SqlStore::recordings(const RecordingFilter& filter, const Page& page) {
  return database_->read([&](Connection& c) { return tables::recordings(c, filter, page); });
}

Result<Counts> SqlStore::counts(const std::optional<Visibility>& visible) {
  return database_->read([&](Connection& c) { return tables::counts(c, visible); });
}

Result<EndedCounts> SqlStore::ended_since(UtcMicros since, const std::optional<Visibility>& visible) {
  return database_->read([&](Connection& c) { return tables::ended_since(c, since, visible); });
}

Result<bool> SqlStore::sees_job(std::string_view job, const Visibility& visible) {
  return database_->read([&](Connection& c) { return tables::sees_job(c, job, visible); });
}

Result<bool> SqlStore::is_owner(std::string_view object, std::string_view token) {
  return database_->read([&](Connection& c) { return tables::is_owner(c, object, token); });
}

Result<DeviceOverviews> SqlStore::overviews(const std::vector<std::string>& device_ids,
                                            const std::optional<Visibility>& visible) {
  return database_->read([&](Connection& c) { return tables::overviews(c, device_ids, visible); });
}

Result<Recording> SqlStore::revise_recording(const Recording& recording, std::int64_t expected_revision) {
  return audited_.write(
      [&](Connection& c) { return tables::revise_recording(c, recording, expected_revision, now(c)); },
      [](const Recording& revised) { return changed("recording.change", revised.id); });
}

Status SqlStore::remove_recording(std::string_view id, std::int64_t expected_revision) {
  return remove("recording.delete", id,
                [&](Connection& c) { return tables::remove_recording(c, id, expected_revision, now(c)); });
}

Result<std::vector<StoredRecording>> SqlStore::stored_recordings(std::string_view after, int most) {
  return database_->read([&](Connection& c) { return tables::stored_recordings(c, after, most); });
}

Status SqlStore::expire_recording(std::string_view id) {
  Caller self;
  self.principal.name = "daemon";
  const ActingFor acting(self);
  return remove("recording.expire", id, [&](Connection& c) { return tables::expire_recording(c, id, now(c)); });
}

Status SqlStore::remove_device(std::string_view id, std::int64_t expected_revision) {
  return remove("device.delete", id, [&](Connection& c) { return tables::remove_device(c, id, expected_revision); });
}

Status SqlStore::remove_study(std::string_view id) {
  return remove("study.delete", id, [&](Connection& c) { return tables::remove_study(c, id); });
}

Status SqlStore::remove_drive(std::string_view id) {
  return remove("drive.delete", id, [&](Connection& c) { return tables::remove_drive(c, id); });
}

Status SqlStore::remove_calibration(std::string_view id) {
  return remove("calibration.delete", id, [&](Connection& c) { return tables::remove_calibration(c, id); });
}

Status SqlStore::remove_model(std::string_view id) {
  return remove("model.delete", id, [&](Connection& c) { return tables::remove_model(c, id); });
}

Status SqlStore::remove_investigation(std::string_view id) {
  return remove("investigation.delete", id, [&](Connection& c) { return tables::remove_investigation(c, id); });
}

Result<std::vector<std::string>> SqlStore::blob_hashes() {
  return database_->read([](Connection& c) { return tables::blob_hashes(c); });
}

Result<bool> SqlStore::remove_unused_blob(std::string_view sha256) {
  return database_->write(WriteKind::Serial, [&](Connection& c) { return tables::remove_unused_blob(c, sha256); });
}

Result<EnqueuedJob> SqlStore::enqueue(const NewJob& job) {
  const Caller* const caller = caller_of_thread();
  return audited_.write(
      [&](Connection& c) -> Result<EnqueuedJob> {
        auto queued = tables::enqueue(c, job, now(c));
        if (queued && queued->job.is_damaged) {
          return fail(damaged_in("jobs", queued->job.id));
        }
        if (queued) {
          if (Status noted = note_caller(c, queued->job, caller); !noted) {
            return fail(noted.error());
          }
        }
        return queued;
      },
      [](const EnqueuedJob& queued) { return made("job.create", queued.created, queued.job.id); });
}

Result<Job> SqlStore::job(std::string_view id) {
  return database_->read([&](Connection& c) { return tables::sound_job(c, id); });
}

Result<std::vector<Job>> SqlStore::jobs(const JobFilter& filter, const Page& page) {
  auto found = database_->read([&](Connection& c) { return tables::jobs(c, filter, page); });
  if (found) {
    for (const Job& listed : *found) {
      if (listed.is_damaged) {
        database_->tell_damage(damaged_in("jobs", listed.id));
      }
    }
  }
  return found;
}

Result<std::optional<Job>> SqlStore::claim(std::int64_t lease_micros, std::int64_t running_per_token,
                                           const std::vector<KnownKind>& known) {
  return database_->write(WriteKind::Fenced, [&](Connection& c) {
    return tables::claim(c, lease_micros, running_per_token, known, now(c));
  });
}

Result<LeaseStatus> SqlStore::renew(const Lease& lease, std::int64_t lease_micros) {
  return database_->write(WriteKind::Fenced,
                          [&](Connection& c) { return tables::renew(c, lease, lease_micros, now(c)); });
}

Result<LeaseStatus> SqlStore::report_progress(const Lease& lease, std::string_view stage, double progress) {
  return database_->write(WriteKind::Fenced,
                          [&](Connection& c) { return tables::report_progress(c, lease, stage, progress, now(c)); });
}

Result<LeaseStatus> SqlStore::succeed(const Lease& lease, const JobResults& results) {
  return database_->write(WriteKind::Serial, [&](Connection& c) { return tables::succeed(c, lease, results, now(c)); });
}

Result<LeaseStatus> SqlStore::fail_attempt(const Lease& lease, const AttemptFailure& failure) {
  std::uint64_t seed = 0;
  {
    const std::lock_guard<std::mutex> guard(jitter_mutex_);
    seed = jitter_();
  }
  return database_->write(WriteKind::Serial, [&](Connection& c) {
    std::mt19937_64 jitter(seed);
    return tables::fail_attempt(c, lease, failure, jitter, now(c));
  });
}

Result<LeaseStatus> SqlStore::acknowledge_cancel(const Lease& lease) {
  return database_->write(WriteKind::Serial,
                          [&](Connection& c) { return tables::acknowledge_cancel(c, lease, now(c)); });
}

Result<LeaseStatus> SqlStore::release(const Lease& lease) {
  return database_->write(WriteKind::Serial, [&](Connection& c) { return tables::release(c, lease, now(c)); });
}

Result<Job> SqlStore::request_cancel(std::string_view id) {
  const auto asked = audited_.write([&](Connection& c) { return tables::request_cancel(c, id, now(c)); },
                                    [](const Job& job) { return changed("job.cancel", job.id); });
  return asked ? job(asked->id) : asked;  // one that is damaged is cancelled as well, and not shown
}

Result<int> SqlStore::rescue_expired() {
  return database_->write(WriteKind::Serial, [&](Connection& c) {
    const UtcMicros time = now(c);
    return tables::end_leases(c, time, time);
  });
}

Result<int> SqlStore::settle_recordings() {
  constexpr int kTimes = 100;  // the rest is for the next sweep
  Result<bool> more = true;
  for (int time = 0; time < kTimes && more.value_or(false); ++time) {
    more = database_->write(WriteKind::Fenced, [](Connection& c) { return tables::settle_amounts(c); });
  }
  const auto listed = database_->write(WriteKind::Fenced, [](Connection& c) { return tables::settle_recordings(c); });
  return more ? listed : fail(more.error());
}

Result<int> SqlStore::end_all_leases() {
  return database_->write(WriteKind::Serial,
                          [&](Connection& c) { return tables::end_leases(c, std::nullopt, now(c)); });
}

Result<std::vector<JobEvent>> SqlStore::events_after(std::string_view job_id, std::int64_t sequence, int limit) {
  return database_->read([&](Connection& c) { return tables::events_after(c, job_id, sequence, limit); });
}

Result<std::string> SqlStore::result_document(std::string_view job_id) {
  return database_->read([&](Connection& c) { return tables::result_document(c, job_id); });
}

Result<Fit> SqlStore::fit(std::string_view id) {
  return database_->read([&](Connection& c) { return tables::fit(c, id); });
}

Result<std::vector<Fit>> SqlStore::fits(const FitFilter& filter, const Page& page) {
  return database_->read([&](Connection& c) { return tables::fits(c, filter, page); });
}

Result<std::vector<ResultVerdict>> SqlStore::verdicts(const VerdictFilter& filter, const Page& page) {
  return database_->read([&](Connection& c) { return tables::verdicts(c, filter, page); });
}

Result<std::vector<ChannelResult>> SqlStore::latest_channel_results(std::string_view device_id,
                                                                    std::string_view quantity, std::string_view axis) {
  return database_->read([&](Connection& c) { return tables::latest_channel_results(c, device_id, quantity, axis); });
}

Result<std::vector<std::string>> SqlStore::axes_with_results(std::string_view device_id, std::string_view quantity) {
  return database_->read([&](Connection& c) { return tables::axes_with_results(c, device_id, quantity); });
}

Result<AxisResults> SqlStore::axis_results(const SensorAxis& axis) {
  return database_->read([&](Connection& c) { return tables::axis_results(c, axis); });
}

Result<std::optional<PooledArtefact>> SqlStore::pooled_artefact(const SensorAxis& axis, std::string_view name) {
  return database_->read([&](Connection& c) { return tables::pooled_artefact(c, axis, name); });
}

Result<int> SqlStore::keep_missing_glances(const GlanceOf& glance_of) {
  int kept = 0;
  while (true) {
    const Result<int> some =
        database_->write(WriteKind::Serial, [&](Connection& c) { return tables::keep_glances(c, glance_of); });
    if (!some || *some == 0) {
      return some ? Result<int>(kept) : some;
    }
    kept += *some;
  }
}

Result<int> SqlStore::seal_unsealed_rows() {
  constexpr int kRowsAtOnce = 100;
  int sealed = 0;
  for (const SealedTable& table : sealed_tables()) {
    int some = kRowsAtOnce;
    while (some > 0) {
      const Result<int> done =
          database_->write(WriteKind::Serial, [&](Connection& c) { return seal_rows(c, table, kRowsAtOnce); });
      if (!done) {
        return done;
      }
      some = *done;
      sealed += some;
    }
  }
  return sealed;
}

Status SqlStore::read_back_rows(const ReadingPace& pace, const std::function<void(const std::string& row)>& damaged) {
  constexpr int kRowsAtOnce = 20;  // whole documents, which may be large
  for (const SealedTable& table : sealed_tables()) {
    std::vector<std::string> after;
    do {
      const Result<ReadBack> some =
          database_->read([&](Connection& c) { return read_back(c, table, after, kRowsAtOnce); });
      if (!some) {
        return fail(some.error());
      }
      std::ranges::for_each(some->damaged, damaged);
      after = some->last;
      if (!pace(static_cast<std::size_t>(some->bytes))) {
        return fail(ErrorCode::Cancelled, "The check was stopped.");
      }
    } while (!after.empty());
  }
  return {};
}

Result<std::optional<bool>> SqlStore::is_damaged(std::string_view row) {
  return database_->read([&](Connection& c) { return server::is_damaged(c, row); });
}

Result<int> SqlStore::queue_missing_pools() {
  return database_->write(WriteKind::Serial, [&](Connection& c) { return tables::queue_missing_pools(c, now(c)); });
}

Result<Store::StudyOutcome> SqlStore::add_study(const Study& study) {
  return audited_.write([&](Connection& c) { return tables::add_study(c, study, now(c)); },
                        [](const StudyOutcome& o) { return made("study.create", o.created, o.study.id); });
}

Result<Study> SqlStore::study(std::string_view id) {
  return database_->read([&](Connection& c) { return tables::study(c, id); });
}

Result<std::vector<Study>> SqlStore::studies(const std::optional<std::string>& device_id, const Page& page) {
  return database_->read([&](Connection& c) { return tables::studies(c, device_id, page); });
}

Result<Store::DriveOutcome> SqlStore::add_drive(const StoredDrive& drive) {
  return audited_.write([&](Connection& c) { return tables::add_drive(c, drive, now(c)); },
                        [](const DriveOutcome& o) { return made("drive.create", o.created, o.drive.id); });
}

Result<StoredDrive> SqlStore::drive(std::string_view id) {
  return database_->read([&](Connection& c) { return tables::drive(c, id); });
}

Result<std::vector<StoredDrive>> SqlStore::drives(const std::optional<std::string>& device_id, const Page& page) {
  return database_->read([&](Connection& c) { return tables::drives(c, device_id, page); });
}

Result<Store::CalibrationOutcome> SqlStore::add_calibration(const StoredCalibration& calibration) {
  return audited_.write(
      [&](Connection& c) { return tables::add_calibration(c, calibration, now(c)); },
      [](const CalibrationOutcome& o) { return made("calibration.create", o.created, o.calibration.id); });
}

Result<StoredCalibration> SqlStore::calibration(std::string_view id) {
  return database_->read([&](Connection& c) { return tables::calibration(c, id); });
}

Result<std::vector<StoredCalibration>> SqlStore::calibrations(const std::optional<std::string>& device_id,
                                                              const Page& page) {
  return database_->read([&](Connection& c) { return tables::calibrations(c, device_id, page); });
}

Result<Store::ModelOutcome> SqlStore::add_model(const Model& model) {
  const Caller* const caller = caller_of_thread();
  return audited_.write(
      [&](Connection& c) -> Result<ModelOutcome> {
        auto added = tables::add_model(c, model, now(c));
        if (added && caller != nullptr) {
          if (Status noted = tables::add_owner(c, added->model.id, *caller); !noted) {
            return fail(noted.error());
          }
        }
        return added;
      },
      [](const ModelOutcome& o) { return made("model.create", o.created, o.model.id); });
}

Result<Model> SqlStore::model(std::string_view id) {
  return database_->read([&](Connection& c) { return tables::model(c, id); });
}

Result<std::vector<Model>> SqlStore::models(const ModelFilter& filter, const Page& page) {
  return database_->read([&](Connection& c) { return tables::models(c, filter, page); });
}

Result<Investigation> SqlStore::investigation(std::string_view id) {
  return database_->read([&](Connection& c) { return tables::investigation(c, id); });
}

Result<std::vector<Investigation>> SqlStore::investigations(const InvestigationFilter& filter, const Page& page) {
  return database_->read([&](Connection& c) { return tables::investigations(c, filter, page); });
}

Result<Anchor> SqlStore::add_anchor(const Anchor& anchor) {
  return audited_.write([&](Connection& c) { return tables::add_anchor(c, anchor, now(c)); },
                        [](const Anchor& made) { return changed("anchor.move", made.device_id); });
}

Result<std::vector<Anchor>> SqlStore::anchors(const std::optional<std::string>& device_id, const Page& page) {
  return database_->read([&](Connection& c) { return tables::anchors(c, device_id, page); });
}

Result<std::string> SqlStore::artefact(std::string_view job_id, std::string_view name) {
  return database_->read([&](Connection& c) { return tables::artefact(c, job_id, name); });
}

Result<std::optional<IdempotentReply>> SqlStore::idempotent_reply(std::string_view key) {
  return database_->read([&](Connection& c) { return tables::idempotent_reply(c, key, now(c)); });
}

Status SqlStore::remember_reply(const IdempotentReply& reply) {
  return database_->write(WriteKind::Serial, [&](Connection& c) { return tables::remember_reply(c, reply, now(c)); });
}

Result<int> SqlStore::forget_old_replies() {
  return database_->write(WriteKind::Serial, [&](Connection& c) { return tables::forget_old_replies(c, now(c)); });
}

}  // namespace driftlab::server
