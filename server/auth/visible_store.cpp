#include "server/auth/visible_store.hpp"

#include "server/store/damaged_row.hpp"
#include "server/store/principal.hpp"

#include <nlohmann/json.hpp>

namespace driftlab::server {
namespace {

/// What the caller of this thread is limited to; nothing: it is not.
std::optional<Visibility> limits() {
  const std::vector<std::string>* const devices = devices_of_caller();
  return devices == nullptr
             ? std::nullopt
             : std::optional(Visibility{nlohmann::json(*devices).dump(), caller_of_thread()->principal.token});
}

Page limited(const Page& page) {
  Page seen = page;
  seen.visible = limits();
  return seen;
}

/// What the store itself says of an object that does not exist.
Error absent(const char* kind, std::string_view id) {
  return {ErrorCode::NotFound,
          "There is no " + std::string(kind) + " \"" + std::string(id) + "\".",
          {{kind, std::string(id)}}};
}

class VisibleStore final : public Store {
 public:
  explicit VisibleStore(Store& whole) : whole_(whole) {}

  Status ping() override { return whole_.ping(); }
  Status write_probe() override { return whole_.write_probe(); }
  [[nodiscard]] std::uint64_t changes() const override { return whole_.changes(); }
  Result<DeviceUsage> usage_of(std::string_view device_id, std::string_view sha256) override {
    return whole_.usage_of(device_id, sha256);
  }
  Result<DeviceUsage> usage_of_token(std::string_view token, std::string_view sha256) override {
    return whole_.usage_of_token(token, sha256);
  }
  Result<int> forget_ended_jobs(UtcMicros before) override { return whole_.forget_ended_jobs(before); }
  Result<Counts> counts(const std::optional<Visibility>& /*visible*/) override { return whole_.counts(limits()); }
  Result<EndedCounts> ended_since(UtcMicros since, const std::optional<Visibility>& /*visible*/) override {
    return whole_.ended_since(since, limits());
  }
  Result<bool> sees_job(std::string_view job, const Visibility& visible) override {
    return whole_.sees_job(job, visible);
  }
  Result<bool> is_owner(std::string_view object, std::string_view token) override {
    return whole_.is_owner(object, token);
  }

  Result<DeviceOutcome> ensure_device(const Device& device) override {
    if (Status allowed = require_device(device.name); !allowed) {
      return fail(allowed.error());
    }
    return whole_.ensure_device(device);
  }
  Result<Device> device(std::string_view id_or_name) override {
    auto found = whole_.device(id_or_name);
    if (found && !require_device(found->name)) {
      return fail(absent("device", id_or_name));
    }
    return found;
  }
  Result<std::vector<Device>> devices(const DeviceFilter& filter, const Page& page) override {
    return whole_.devices(filter, limited(page));
  }
  Result<Device> update_device(std::string_view id, const DeviceChange& change,
                               std::int64_t expected_revision) override {
    if (auto found = device(id); !found) {
      return found;
    }
    return whole_.update_device(id, change, expected_revision);
  }

  Status remove_device(std::string_view id, std::int64_t expected_revision) override {
    return if_seen(device(id), [&] { return whole_.remove_device(id, expected_revision); });
  }

  Result<std::optional<Blob>> blob(std::string_view sha256) override { return whole_.blob(sha256); }
  Result<RecordingOutcome> add_recording(const Blob& blob, const Recording& recording) override {
    if (auto seen = see_device(recording.device_id, "device", recording.device_id); !seen) {
      return fail(seen.error());
    }
    return whole_.add_recording(blob, recording);
  }
  Result<Recording> recording(std::string_view id) override {
    return owned_by_device(whole_.recording(id), "recording", id);
  }
  Result<std::vector<Recording>> recordings_of(const std::vector<std::string>& ids) override {
    auto found = whole_.recordings_of(ids);
    if (found) {
      std::erase_if(*found, [&](const Recording& one) { return !see_device(one.device_id, "recording", one.id); });
    }
    return found;
  }
  Result<std::vector<Recording>> recordings(const RecordingFilter& filter, const Page& page) override {
    return whole_.recordings(filter, limited(page));
  }
  Result<DeviceOverviews> overviews(const std::vector<std::string>& device_ids,
                                    const std::optional<Visibility>& /*visible*/) override {
    return whole_.overviews(device_ids, limits());
  }
  Result<Recording> revise_recording(const Recording& changed, std::int64_t expected_revision) override {
    if (auto found = recording(changed.id); !found) {
      return found;
    }
    return whole_.revise_recording(changed, expected_revision);
  }
  Result<std::vector<StoredRecording>> stored_recordings(std::string_view after, int most) override {
    return whole_.stored_recordings(after, most);  // for the daemon itself
  }
  Status expire_recording(std::string_view id) override { return whole_.expire_recording(id); }
  Status remove_recording(std::string_view id, std::int64_t expected_revision) override {
    return if_seen(recording(id), [&] { return whole_.remove_recording(id, expected_revision); });
  }
  Result<std::vector<std::string>> blob_hashes() override { return whole_.blob_hashes(); }
  Result<bool> remove_unused_blob(std::string_view sha256) override { return whole_.remove_unused_blob(sha256); }

  Result<EnqueuedJob> enqueue(const NewJob& job) override { return whole_.enqueue(job); }
  Result<Job> job(std::string_view id) override {
    if (auto seen = see_job(id); !seen) {
      return fail(seen.error());
    }
    return whole_.job(id);
  }
  Result<std::vector<Job>> jobs(const JobFilter& filter, const Page& page) override {
    return whole_.jobs(filter, limited(page));
  }
  Result<std::optional<Job>> claim(std::int64_t lease_micros, std::int64_t running_per_token,
                                   const std::vector<KnownKind>& known) override {
    return whole_.claim(lease_micros, running_per_token, known);
  }
  PartStore& parts() override { return whole_.parts(); }
  Result<LeaseStatus> renew(const Lease& lease, std::int64_t lease_micros) override {
    return whole_.renew(lease, lease_micros);
  }
  Result<LeaseStatus> report_progress(const Lease& lease, std::string_view stage, double progress) override {
    return whole_.report_progress(lease, stage, progress);
  }
  Result<LeaseStatus> succeed(const Lease& lease, const JobResults& results) override {
    return whole_.succeed(lease, results);
  }
  Result<LeaseStatus> fail_attempt(const Lease& lease, const AttemptFailure& failure) override {
    return whole_.fail_attempt(lease, failure);
  }
  Result<LeaseStatus> acknowledge_cancel(const Lease& lease) override { return whole_.acknowledge_cancel(lease); }
  Result<LeaseStatus> release(const Lease& lease) override { return whole_.release(lease); }
  Result<Job> request_cancel(std::string_view id) override {
    if (auto seen = see_job(id); !seen) {
      return fail(seen.error());
    }
    return whole_.request_cancel(id);
  }
  Result<int> rescue_expired() override { return whole_.rescue_expired(); }
  Result<int> settle_recordings() override { return whole_.settle_recordings(); }
  Result<int> end_all_leases() override { return whole_.end_all_leases(); }
  Result<std::vector<JobEvent>> events_after(std::string_view job_id, std::int64_t sequence, int limit) override {
    if (auto seen = see_job(job_id); !seen) {
      return fail(seen.error());
    }
    return whole_.events_after(job_id, sequence, limit);
  }

  Result<std::string> result_document(std::string_view job_id) override {
    if (auto seen = see_job(job_id); !seen) {
      return fail(seen.error());
    }
    return whole_.result_document(job_id);
  }
  Result<Fit> fit(std::string_view id) override { return owned_by_device(whole_.fit(id), "fit", id); }
  Result<std::vector<Fit>> fits(const FitFilter& filter, const Page& page) override {
    return whole_.fits(filter, limited(page));
  }
  Result<std::vector<ResultVerdict>> verdicts(const VerdictFilter& filter, const Page& page) override {
    return whole_.verdicts(filter, limited(page));
  }
  Result<std::vector<ChannelResult>> latest_channel_results(std::string_view device_id, std::string_view quantity,
                                                            std::string_view axis) override {
    if (auto seen = see_device(device_id, "device", device_id); !seen) {
      return fail(seen.error());
    }
    return whole_.latest_channel_results(device_id, quantity, axis);
  }
  Result<std::vector<std::string>> axes_with_results(std::string_view device_id, std::string_view quantity) override {
    if (auto seen = see_device(device_id, "device", device_id); !seen) {
      return fail(seen.error());
    }
    return whole_.axes_with_results(device_id, quantity);
  }
  Result<AxisResults> axis_results(const SensorAxis& axis) override {
    if (auto seen = see_device(axis.device_id, "device", axis.device_id); !seen) {
      return fail(seen.error());
    }
    return whole_.axis_results(axis);
  }
  Result<std::optional<PooledArtefact>> pooled_artefact(const SensorAxis& axis, std::string_view name) override {
    if (auto seen = see_device(axis.device_id, "device", axis.device_id); !seen) {
      return fail(seen.error());
    }
    return whole_.pooled_artefact(axis, name);
  }
  Result<int> queue_missing_pools() override { return whole_.queue_missing_pools(); }

  Result<StudyOutcome> add_study(const Study& study) override {
    if (auto seen = see_device(study.device_id, "device", study.device_id); !seen) {
      return fail(seen.error());
    }
    return whole_.add_study(study);
  }
  Result<Study> study(std::string_view id) override { return owned_by_device(whole_.study(id), "study", id); }
  Result<std::vector<Study>> studies(const std::optional<std::string>& device_id, const Page& page) override {
    return whole_.studies(device_id, limited(page));
  }

  Status remove_study(std::string_view id) override {
    return if_seen(study(id), [&] { return whole_.remove_study(id); });
  }

  Result<DriveOutcome> add_drive(const StoredDrive& drive) override {
    if (auto seen = see_device(drive.device_id, "device", drive.device_id); !seen) {
      return fail(seen.error());
    }
    return whole_.add_drive(drive);
  }
  Result<StoredDrive> drive(std::string_view id) override { return owned_by_device(whole_.drive(id), "drive", id); }
  Result<std::vector<StoredDrive>> drives(const std::optional<std::string>& device_id, const Page& page) override {
    return whole_.drives(device_id, limited(page));
  }

  Status remove_drive(std::string_view id) override {
    return if_seen(drive(id), [&] { return whole_.remove_drive(id); });
  }

  Result<CalibrationOutcome> add_calibration(const StoredCalibration& calibration) override {
    if (auto seen = see_device(calibration.device_id, "device", calibration.device_id); !seen) {
      return fail(seen.error());
    }
    return whole_.add_calibration(calibration);
  }
  Result<StoredCalibration> calibration(std::string_view id) override {
    return owned_by_device(whole_.calibration(id), "calibration", id);
  }
  Result<std::vector<StoredCalibration>> calibrations(const std::optional<std::string>& device_id,
                                                      const Page& page) override {
    return whole_.calibrations(device_id, limited(page));
  }

  Status remove_calibration(std::string_view id) override {
    return if_seen(calibration(id), [&] { return whole_.remove_calibration(id); });
  }

  Result<ModelOutcome> add_model(const Model& model) override {
    if (!model.parent_id.empty()) {
      if (auto parent = this->model(model.parent_id); !parent) {
        return fail(Error(parent.error()).with("parent", model.parent_id));
      }
    }
    return whole_.add_model(model);
  }
  Result<Model> model(std::string_view id) override {
    auto found = whole_.model(id);
    if (!found || devices_of_caller() == nullptr) {
      return found;
    }
    if (!found->device_id.empty() && see_device(found->device_id, "model", id)) {
      return found;
    }
    const auto own = whole_.is_owner(id, caller_of_thread()->principal.token);
    if (!own) {
      return fail(own.error());
    }
    return *own ? std::move(found) : fail(absent("model", id));
  }
  Result<std::vector<Model>> models(const ModelFilter& filter, const Page& page) override {
    return whole_.models(filter, limited(page));
  }
  Result<Investigation> investigation(std::string_view id) override {
    return owned_by_device(whole_.investigation(id), "investigation", id);
  }
  Result<std::vector<Investigation>> investigations(const InvestigationFilter& filter, const Page& page) override {
    return whole_.investigations(filter, limited(page));
  }

  Status remove_model(std::string_view id) override {
    return if_seen(model(id), [&] { return whole_.remove_model(id); });
  }
  Status remove_investigation(std::string_view id) override {
    return if_seen(investigation(id), [&] { return whole_.remove_investigation(id); });
  }

  Result<Anchor> add_anchor(const Anchor& anchor) override {
    if (auto seen = see_device(anchor.device_id, "device", anchor.device_id); !seen) {
      return fail(seen.error());
    }
    return whole_.add_anchor(anchor);
  }
  Result<std::vector<Anchor>> anchors(const std::optional<std::string>& device_id, const Page& page) override {
    return whole_.anchors(device_id, limited(page));
  }
  Result<std::string> artefact(std::string_view job_id, std::string_view name) override {
    if (auto seen = see_job(job_id); !seen) {
      return fail(seen.error());
    }
    return whole_.artefact(job_id, name);
  }

  Result<std::optional<IdempotentReply>> idempotent_reply(std::string_view key) override {
    return whole_.idempotent_reply(key);
  }
  Status remember_reply(const IdempotentReply& reply) override { return whole_.remember_reply(reply); }
  Result<int> forget_old_replies() override { return whole_.forget_old_replies(); }

 private:
  /// Does the work where the object was found for this caller. What is damaged is removed by a caller who is not
  /// limited to devices: of which one it is cannot be known.
  template <class Row, class Work>
  static Status if_seen(const Result<Row>& found, const Work& work) {
    const bool damaged = !found && !damaged_row_of(found.error()).empty();
    return found || (damaged && devices_of_caller() == nullptr) ? work() : fail(found.error());
  }

  /// Whether the caller may know of the device; an error as for the object named where not.
  Status see_device(std::string_view device_id, const char* kind, std::string_view id) {
    if (devices_of_caller() == nullptr) {
      return {};
    }
    const auto owner = whole_.device(device_id);
    if (!owner && owner.error().code != ErrorCode::NotFound) {
      return fail(owner.error());
    }
    return owner && require_device(owner->name) ? Status{} : tl::unexpected(absent(kind, id));
  }

  template <class Row>
  Result<Row> owned_by_device(Result<Row> found, const char* kind, std::string_view id) {
    if (found) {
      if (Status seen = see_device(found->device_id, kind, id); !seen) {
        return fail(seen.error());
      }
    }
    return found;
  }

  Status see_job(std::string_view id) {
    const auto visible = limits();
    if (!visible) {
      return {};
    }
    const auto seen = whole_.sees_job(id, *visible);
    if (!seen) {
      return fail(seen.error());
    }
    return *seen ? Status{} : tl::unexpected(absent("job", id));
  }

  Store& whole_;
};

}  // namespace

std::unique_ptr<Store> make_visible_store(Store& whole) { return std::make_unique<VisibleStore>(whole); }

}  // namespace driftlab::server
