#include "server/api/record_blob.hpp"

#include "core/read/format.hpp"
#include "core/read/open_recording.hpp"
#include "schema/json/recording_spec.hpp"
#include "server/api/documents.hpp"
#include "server/jobs/recording_calibration.hpp"
#include "server/store/crash_point.hpp"

namespace driftlab::server {
namespace {

constexpr std::uintmax_t kLeastFreeBytes = 64ULL * 1024 * 1024;

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
  auto decoded = decode_file(incoming.path(), incoming.columns_path());
  if (!decoded) {
    return fail(decoded.error());
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

/// A conflict with a recording that is there says by which request that one is changed.
Error naming_patch(Error error) {
  for (const ErrorField& field : error.fields) {
    if (error.code == ErrorCode::Conflict && field.name == "recording_id") {
      error.message = "The device has these bytes already with other metadata; change those with PATCH /v1/recordings/" +
                      field.value + ".";
      break;
    }
  }
  return error;
}

/// Metadata and samples must fit together before anything is kept. The recording's quality as JSON text.
Result<std::string> check_against_columns(ApiContext& context, const UploadMetadata& metadata,
                                          const std::filesystem::path& columns) {
  const bool calibrated = !metadata.spec.calibration.empty();
  auto opened = open_recording(columns, metadata.spec, calibrated ? ViewUse::Analysis : ViewUse::Survey);
  if (!opened) {
    return fail(opened.error());
  }
  std::string quality = to_text(driftlab::to_json(opened->view.window.quality));
  if (!calibrated) {
    return quality;
  }
  const auto device = context.store.device(metadata.device.name);
  auto calibration = calibration_of(context.store, metadata.spec, device ? device->id : "");
  if (!calibration) {
    return fail(calibration.error());
  }
  if (auto applied = apply_calibration(*calibration, opened->view); !applied) {
    return fail(applied.error());
  }
  return quality;
}

}  // namespace

Result<Response> record_blob(ApiContext& context, IncomingBlob& blob, const UploadMetadata& metadata) {
  auto decoded = decode(context, blob);
  if (!decoded) {
    return fail(decoded.error());
  }
  crash_point("upload.decoded");
  auto quality = check_against_columns(context, metadata, decoded->columns);
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
  recording.condition = driftlab::to_text(metadata.spec.condition);
  recording.quality_json = *quality;
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
  response.headers.emplace_back("ETag", etag_of(recorded.id, recorded.revision));
  return response;
}

Status require_space(const ApiContext& context) {
  if (const auto space = context.blobs.space(); space && space->free_bytes < kLeastFreeBytes) {
    return fail(ErrorCode::DiskFull, "Less than 64 MiB are free where the daemon keeps its data.");
  }
  return {};
}

std::vector<std::string_view> metadata_parameters() {
  return {"device", "id",      "condition",    "axis",       "value",      "unit",
          "direction", "rate_hz", "columns", "trim_start_s", "trim_end_s", "calibration"};
}

}  // namespace driftlab::server
