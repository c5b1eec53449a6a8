#include "server/api/record_blob.hpp"

#include "core/analysis/survey_recording.hpp"
#include "core/read/format.hpp"
#include "core/read/trace_pyramid.hpp"
#include "schema/json/recording_spec.hpp"
#include "schema/json/recording_survey.hpp"
#include "server/api/documents.hpp"
#include "server/api/stored_blob.hpp"
#include "server/jobs/recording_calibration.hpp"
#include "server/jobs/stored_recordings.hpp"
#include "server/store/crash_point.hpp"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <stop_token>
#include <thread>

namespace driftlab::server {
namespace {

/// Asks a decoding to stop when its time is over or the daemon stops; what it did not take part in asks for nothing.
class DecodeWatch {
 public:
  DecodeWatch(std::chrono::seconds time, const std::stop_token& daemon)
      : with_daemon_(daemon, [this] { stop_.request_stop(); }), timer_([this, time](const std::stop_token& ended) {
          std::unique_lock<std::mutex> lock(mutex_);
          std::condition_variable_any waiting;
          if (!waiting.wait_for(lock, ended, time, [] { return false; }) && !ended.stop_requested()) {
            too_slow_ = true;
            stop_.request_stop();
          }
        }) {}
  [[nodiscard]] std::stop_token token() const { return stop_.get_token(); }
  [[nodiscard]] bool too_slow() const { return too_slow_; }

 private:
  std::stop_source stop_;
  std::atomic<bool> too_slow_{false};
  std::mutex mutex_;
  std::stop_callback<std::function<void()>> with_daemon_;
  std::jthread timer_;
};

struct DecodedBlob {
  Blob row;
  std::filesystem::path columns;
};

/// The row of these bytes: known already, or decoded now.
Result<DecodedBlob> decode(ApiContext& context, const IncomingBlob& incoming) {
  auto known = context.store.blob(incoming.sha256());
  if (!known) {
    return fail(known.error());
  }
  const std::optional<Blob>& blob = *known;
  if (blob && ColumnFile::open(context.blobs.columns_path(incoming.sha256()))) {
    return DecodedBlob{*blob, context.blobs.columns_path(incoming.sha256())};
  }
  const Budgets& budgets = context.budgets;
  const std::int64_t seconds =
      budgets.decode_seconds + static_cast<std::int64_t>(incoming.size()) / budgets.decode_bytes_per_second;
  const DecodeWatch watch(std::chrono::seconds(seconds), context.stopping);
  RunControl control;
  control.stop = watch.token();
  auto decoded = decode_file(incoming.path(), incoming.columns_path(), decode_limits(budgets), control);
  if (!decoded && watch.too_slow()) {
    return fail(ErrorCode::LimitExceeded, "The file was not decoded in " + std::to_string(seconds) + " s " +
                                              naming_budget("decode_seconds", budgets.decode_seconds) +
                                              "; nothing was kept.");
  }
  if (!decoded) {
    return fail(decoded.error());
  }
  if (auto drawn = add_pyramid(incoming.columns_path()); !drawn) {
    return fail(drawn.error());
  }
  Blob row;
  row.sha256 = incoming.sha256();
  row.bytes = static_cast<std::int64_t>(incoming.size());
  row.format = decoded->format;
  row.compression = driftlab::name_of(decoded->compression);
  row.rows = static_cast<std::int64_t>(decoded->rows);
  row.columns_json = to_text(Json(decoded->names));
  row.notes_json = to_text(Json(decoded->notes));
  row.created_at = context.clock.now();
  return DecodedBlob{std::move(row), incoming.columns_path()};
}

/// Error: DiskFull naming the budget that `usage` of a device or a token and `more` bytes would pass.
Status require_within(const DeviceUsage& usage, std::uint64_t more, std::string_view whose, const Budget& count,
                      const Budget& bytes, const Budgets& budgets) {
  const bool many = usage.recordings >= budgets.*count.value;
  if (!many && usage.bytes + static_cast<std::int64_t>(more) <= budgets.*bytes.value) {
    return {};
  }
  const Budget& passed = many ? count : bytes;
  return fail(ErrorCode::DiskFull, "The " + std::string(whose) + " has all that it may have " +
                                       naming_budget(passed.name, budgets.*passed.value) +
                                       "; remove recordings, or ask for a larger budget.");
}

/// Error: DiskFull naming the budget, where the device or whoever uploads has all it may have.
Status require_quota(ApiContext& context, const IncomingBlob& blob, const std::string& device_name,
                     std::string_view upload) {
  const auto device = context.store.device(device_name);
  const auto usage = context.store.usage_of(device ? device->id : "", blob.sha256());
  if (!usage) {
    return fail(usage.error());
  }
  if (usage->holds_these_bytes) {
    return {};
  }
  const Status within = require_within(*usage, blob.size(), "device", budget_of(&Budgets::recordings_per_device),
                                       budget_of(&Budgets::device_bytes), context.budgets);
  return within ? require_quota_of_token(context, blob.sha256(), blob.size(), upload) : within;
}

/// A conflict with a recording that is there says by which request that one is changed, and what is other: what the
/// recording means, or its labels, session or time alone.
Error naming_patch(Error error) {
  const auto field = [&](std::string_view name) -> std::string {
    for (const ErrorField& each : error.fields) {
      if (each.name == name) {
        return each.value;
      }
    }
    return "";
  };
  if (const std::string id = field("recording_id"); error.code == ErrorCode::Conflict && !id.empty()) {
    const bool tags = field("differs") == "labels";
    error.message = std::string("The device has these bytes already with other ") +
                    (tags ? "labels, session or recorded_at" : "metadata") +
                    "; change those with PATCH /v1/recordings/" + id + ".";
  }
  return error;
}

}  // namespace

Result<std::string> surveyed_quality(ApiContext& context, const std::filesystem::path& columns,
                                     const RecordingSpec& spec, const Device& device) {
  auto calibration = calibration_of(context.store, spec, device.id);
  if (!calibration) {
    return fail(calibration.error());
  }
  const std::vector<std::string> hardware = hardware_of(device);
  const auto survey = survey_recording({columns, spec, std::move(*calibration), hardware});
  if (!survey) {
    return fail(survey.error());
  }
  return to_text(driftlab::to_json(*survey));
}

Status require_quota_of_token(ApiContext& context, std::string_view sha256, std::uint64_t more,
                              std::string_view upload) {
  const Caller* const caller = caller_of_thread();
  if (caller == nullptr || caller->principal.token.empty()) {
    return {};
  }
  auto usage = context.store.usage_of_token(caller->principal.token, sha256);
  if (!usage) {
    return fail(usage.error());
  }
  if (context.uploads) {
    const auto open = context.uploads->open_of(caller->principal.token, upload);
    usage->recordings += open.uploads;
    usage->bytes += open.bytes;
  }
  return require_within(*usage, more, "token", budget_of(&Budgets::recordings_per_token),
                        budget_of(&Budgets::token_bytes), context.budgets);
}

Result<Response> record_blob(ApiContext& context, IncomingBlob& blob, const UploadMetadata& metadata,
                             std::string_view upload) {
  if (auto own = require_device(metadata.device.name); !own) {
    return fail(own.error());
  }
  if (auto allowed = require_quota(context, blob, metadata.device.name, upload); !allowed) {
    return fail(allowed.error());
  }
  auto decoded = decode(context, blob);
  if (!decoded) {
    return fail(decoded.error());
  }
  crash_point("upload.decoded");
  const auto known_device = context.store.device(metadata.device.name);
  auto quality =
      surveyed_quality(context, decoded->columns, metadata.spec, known_device ? *known_device : metadata.device);
  if (!quality) {
    return fail(quality.error());
  }
  if (auto kept = blob.keep(); !kept) {
    return fail(kept.error());
  }
  auto device = context.store.ensure_device(metadata.device);
  if (!device) {
    return fail(device.error());
  }
  Recording recording;
  recording.device_id = device->device.id;
  recording.blob_sha256 = decoded->row.sha256;
  recording.metadata_json = canonical_text(driftlab::to_json(metadata.spec));
  recording.condition = driftlab::to_text(without_heading(metadata.spec.condition));
  recording.quality_json = *quality;
  recording.tags_json = canonical_text(driftlab::to_json(metadata.tags));
  recording.file_name = metadata.file_name;
  auto outcome = context.store.add_recording(decoded->row, recording);
  if (!outcome) {
    return fail(naming_patch(outcome.error()));
  }
  crash_point("upload.recorded");
  const Recording& recorded = outcome->recording;
  if (outcome->created) {
    context.events.add("recordings", "recording.created",
                       Json{{"recording", recorded.id}, {"device", recorded.device_id}});
  }
  Response response = json_response(outcome->created ? 201 : 200, to_json(recorded, &decoded->row));
  response.headers.emplace_back("Location", "/v1/recordings/" + recorded.id);
  response.headers.emplace_back("ETag", shown_etag(etag_of(recorded), recorded.latest_job));
  return response;
}

Status require_space(const ApiContext& context) {
  const auto least = static_cast<std::uintmax_t>(context.budgets.least_free_bytes);
  if (const auto space = context.blobs.space(); space && space->free_bytes < least) {
    return fail(ErrorCode::DiskFull, "Too little is free where the daemon keeps its data " +
                                         naming_budget("least_free_bytes", context.budgets.least_free_bytes) + ".");
  }
  return {};
}

std::vector<std::string_view> metadata_parameters() {
  return {"device",      "id",      "condition", "axis",        "value",        "unit",
          "direction",   "rate_hz", "columns",   "stream",      "trim_start_s", "trim_end_s",
          "calibration", "labels",  "session",   "recorded_at", "file_name"};
}

}  // namespace driftlab::server
