#include "schema/json/recording_spec.hpp"
#include "server/api/api.hpp"
#include "server/api/documents.hpp"
#include "server/api/record_blob.hpp"
#include "server/api/upload.hpp"
#include "server/api/upload_metadata.hpp"
#include "server/http/problem.hpp"
#include "server/store/damaged_row.hpp"

namespace driftlab::server {
namespace {

Result<Response> recording_response(ApiContext& context, int status, const Recording& recording) {
  auto blob = context.store.blob(recording.blob_sha256);
  if (!blob) {
    return fail(blob.error());
  }
  const std::optional<Blob>& kept = *blob;
  Response response = json_response(status, to_json(recording, kept ? &*kept : nullptr));
  response.headers.emplace_back("ETag", shown_etag(etag_of(recording), recording.latest_job));
  return response;
}

Result<Response> list_recordings(ApiContext& context, const Request& request) {
  RecordingFilter filter;
  auto device_id = device_filter(context.store, request);
  if (!device_id) {
    return fail(device_id.error());
  }
  filter.device_id = std::move(*device_id);
  if (const auto text = request.parameter("condition")) {
    auto condition = parse_condition(*text);
    if (!condition) {
      return fail(Error(condition.error()).with("parameter", "condition"));
    }
    filter.condition = driftlab::to_text(without_heading(*condition));
  }
  if (const auto text = request.parameter("labels")) {
    auto labels = parse_labels(*text);
    if (!labels) {
      return fail(labels.error());
    }
    filter.labels = label_words(*labels);
  }
  auto sought = text_filter(request);
  auto since = since_filter(request);
  if (!sought || !since) {
    return fail(sought ? since.error() : sought.error());
  }
  filter.text = std::move(*sought);
  filter.since = *since;
  if (const auto wanted = request.parameter("has_result")) {
    if (*wanted != "true" && *wanted != "false") {
      return fail(ErrorCode::InvalidArgument, "has_result is true or false.", {{"parameter", "has_result"}});
    }
    filter.has_result = *wanted == "true";
  }
  return list_rows(
      request, [&](const Page& page) { return context.store.recordings(filter, page); },
      [](const Recording& recording) { return to_json(recording, nullptr); });
}

Result<Response> get_recording(ApiContext& context, const Request& request) {
  auto recording = context.store.recording(request.parameters[0]);
  if (!recording) {
    return fail(recording.error());
  }
  return recording_response(context, 200, *recording);
}

Result<Response> patch_recording(ApiContext& context, const Request& request) {
  auto recording = context.store.recording(request.parameters[0]);
  if (!recording) {
    return fail(recording.error());
  }
  if (auto refusal = refuse_stale(request, etag_of(*recording))) {
    return std::move(*refusal);
  }
  auto body = parse_json(request.body);
  if (!body) {
    return fail(body.error());
  }
  if (!body->is_object()) {
    return fail(ErrorCode::ParseError, "The body must be an object with the members of the metadata to change.");
  }
  // JSON merge patch (RFC 7396) on the first level: a member given replaces the one there, null removes it.
  Json metadata = described(*recording);
  for (const auto& [name, value] : body->items()) {
    if (value.is_null()) {
      metadata.erase(name);
    } else {
      metadata[name] = value;
    }
  }
  Faults faults;
  const RecordingSpec spec = recording_spec_from_json(metadata, "", faults, FileMember::Refused);
  limit_names(spec, *request.budgets, "", faults, &*body);
  Faults found_already;
  const RecordingTags tags = recording_tags_from_json(metadata, "", found_already);
  limit_tags(tags, *request.budgets, "", faults);
  if (!faults.none()) {
    return fail(faults.error());
  }
  const auto device = context.store.device(recording->device_id);
  if (!device) {
    return fail(device.error());
  }
  auto quality = surveyed_quality(context, context.blobs.columns_path(recording->blob_sha256), spec, *device);
  if (!quality) {
    return fail(quality.error());
  }
  Recording changed = *recording;
  changed.metadata_json = canonical_text(driftlab::to_json(spec));
  changed.condition = driftlab::to_text(without_heading(spec.condition));
  changed.quality_json = *quality;
  changed.tags_json = canonical_text(driftlab::to_json(tags));
  if (changed.metadata_json == recording->metadata_json && changed.tags_json == recording->tags_json) {
    return recording_response(context, 200, *recording);
  }
  auto revised = context.store.revise_recording(changed, recording->revision);
  if (!revised) {
    return fail(revised.error());
  }
  context.events.add("recordings", "recording.changed",
                     Json{{"recording", revised->id}, {"device", revised->device_id}});
  context.wake_workers();  // what its results took part in is pooled anew
  return recording_response(context, 200, *revised);
}

Result<Response> delete_recording(ApiContext& context, const Request& request) {
  auto recording = context.store.recording(request.parameters[0]);
  if (!recording && !damaged_row_of(recording.error()).empty() && request.header("if-match") == "*") {
    return removed_response(context.store.remove_recording(request.parameters[0], Store::kAnyRevision));
  }
  if (!recording) {
    return fail(recording.error());
  }
  if (auto refusal = refuse_stale(request, etag_of(*recording))) {
    return std::move(*refusal);
  }
  Status removed = context.store.remove_recording(recording->id, recording->revision);
  if (!removed && removed.error().code == ErrorCode::DiskFull && context.make_room && context.make_room()) {
    removed = context.store.remove_recording(recording->id, recording->revision);
  }
  if (!removed) {
    return fail(removed.error());
  }
  context.events.add("recordings", "recording.deleted",
                     Json{{"recording", recording->id}, {"device", recording->device_id}});
  context.wake_workers();  // what its results took part in is pooled anew
  // The files stay: another device's recording may hold the same bytes, and an upload of them may be running. Without a
  // row the sweeper removes them after a day; on a disk that is nearly full they go now, unless they came within the
  // last minute.
  const auto unused = context.store.remove_unused_blob(recording->blob_sha256);
  if (!unused) {
    return fail(unused.error());
  }
  if (*unused && context.is_nearly_full && context.is_nearly_full()) {
    const auto gone = context.blobs.remove_if_older(recording->blob_sha256, std::chrono::minutes(1));
    if (!gone) {
      return fail(gone.error());
    }
  }
  Response response;
  response.status = 204;
  return response;
}

}  // namespace

void add_recording_routes(Router& router, ApiContext& context) {
  router.add({"GET",
              "/v1/recordings",
              "listRecordings",
              {"limit", "cursor", "sort", "device", "condition", "labels", "q", "since", "has_result"},
              Handler([&](const Request& request) { return list_recordings(context, request); })});
  router.add({"POST", "/v1/recordings", "uploadRecording", metadata_parameters(),
              UploadHandler([&](const Request& request) { return begin_upload(context, request); })});
  router.add(from_rows({"GET", "/v1/recordings/{id}", "getRecording", {}, Handler([&](const Request& request) {
                          return get_recording(context, request);
                        })}));
  router.add(
      in_lane(Lane::Slow, {"PATCH", "/v1/recordings/{id}", "changeRecording", {}, Handler([&](const Request& request) {
                             return patch_recording(context, request);
                           })}));
  router.add({"DELETE", "/v1/recordings/{id}", "deleteRecording", {}, Handler([&](const Request& request) {
                return delete_recording(context, request);
              })});
}

}  // namespace driftlab::server
