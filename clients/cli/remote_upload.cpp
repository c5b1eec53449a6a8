#include "clients/cli/remote_upload.hpp"

#include "core/signal/number.hpp"
#include "schema/json/recording_spec.hpp"

#include <utility>

namespace driftlab::cli {
namespace {

std::string columns_text(const std::map<std::string, ColumnRole>& columns) {
  std::string text;
  for (const auto& [name, role] : columns) {
    text += (text.empty() ? "" : ",") + name + "=" + std::string(name_of(role.quantity)) + ":" + role.axis;
    if (role.unit) {
      text += ":" + role.unit->symbol;
    }
  }
  return text;
}

std::string upload_target(const std::string& device, const RecordingSpec& spec, const RecordingTags& tags,
                          const std::string& file_name) {
  std::string target = "/v1/recordings?device=" + percent_encode(device) +
                       "&condition=" + percent_encode(to_text(spec.condition)) + "&id=" + percent_encode(spec.id);
  if (spec.rate_hz) {
    target += "&rate_hz=" + to_text(*spec.rate_hz);
  }
  if (!spec.columns.empty()) {
    target += "&columns=" + percent_encode(columns_text(spec.columns));
  }
  if (!spec.stream.empty()) {
    target += "&stream=" + percent_encode(spec.stream);
  }
  if (spec.trim.start_s > 0.0) {
    target += "&trim_start_s=" + to_text(spec.trim.start_s);
  }
  if (spec.trim.end_s > 0.0) {
    target += "&trim_end_s=" + to_text(spec.trim.end_s);
  }
  if (!spec.calibration.empty()) {
    target += "&calibration=" + percent_encode(spec.calibration);
  }
  std::string labels;
  for (const std::string& word : label_words(tags.labels)) {
    labels += (labels.empty() ? "" : ",") + word;
  }
  for (const auto& [name, text] : {std::pair<const char*, const std::string*>{"labels", &labels},
                                   {"session", &tags.session},
                                   {"recorded_at", &tags.recorded_at},
                                   {"file_name", &file_name}}) {
    if (!text->empty()) {
      target += "&" + std::string(name) + "=" + percent_encode(*text);
    }
  }
  return target;
}

}  // namespace

tl::expected<Json, Failure> upload_recording(HttpClient& client, const std::string& device, const RecordingSpec& spec,
                                             const RecordingTags& tags, const std::filesystem::path& file,
                                             const std::string& file_name, const std::function<void(double)>& sent) {
  auto reply = client.upload(upload_target(device, spec, tags, file_name), file, sent);
  if (!reply) {
    const bool missing = reply.error().code == ErrorCode::NotFound;
    return tl::unexpected(Failure{reply.error(), missing ? Exit::BadInput : Exit::ServerOrJob});
  }
  if (reply->status != 200 && reply->status != 201) {
    return refused(*reply);
  }
  auto recording = parse_json(reply->body);
  if (!recording || !recording->contains("id")) {
    return unreachable(Error{ErrorCode::ParseError, "The daemon's answer to an upload is not understood.", {}});
  }
  return (*recording)["id"];
}

tl::expected<std::vector<InputFile>, Failure> with_stored_calibrations(HttpClient& client, const Inputs& inputs) {
  std::vector<InputFile> files = inputs.files;
  for (InputFile& file : files) {
    if (file.spec.calibration.empty()) {
      continue;
    }
    const Json request{{"device", {{"id", inputs.device}}}, {"calibration", file.calibration_document}};
    auto id = post_for_id(client, "/v1/calibrations", request, "a calibration");
    if (!id) {
      return tl::unexpected(id.error());
    }
    file.spec.calibration = id->get<std::string>();
  }
  return files;
}

tl::expected<Json, Failure> upload_file(HttpClient& client, const std::string& device, const InputFile& file,
                                        const RecordingTags& tags, const std::function<void(double)>& sent) {
  auto id = upload_recording(client, device, file.spec, tags, file.bytes(), file.path.filename().string(), sent);
  if (!id) {
    Failure failure = id.error();
    failure.error.message = file.path.string() + ": " + failure.error.message;
    return tl::unexpected(std::move(failure));
  }
  return id;
}

tl::expected<KeptRecording, Failure> kept_under_other_labels(HttpClient& client, const Failure& refusal,
                                                             const std::map<std::string, std::string>& wanted) {
  KeptRecording kept;
  bool labels_alone = false;
  for (const ErrorField& field : refusal.error.fields) {
    kept.id = field.name == "recording_id" ? field.value : kept.id;
    labels_alone = labels_alone || (field.name == "differs" && field.value == "labels");
  }
  if (!labels_alone || kept.id.empty()) {
    return tl::unexpected(refusal);
  }
  const auto reply = client.get("/v1/recordings/" + kept.id);
  if (!reply) {
    return unreachable(reply.error());
  }
  const auto document = parse_json(reply->body);
  if (reply->status != 200 || !document) {
    return refused(*reply);
  }
  Faults faults;
  kept.labels = recording_tags_from_json(document->value("metadata", Json::object()), "", faults).labels;
  if (!faults.none() || kept.labels == wanted) {  // the same labels: session or time is other, which is for a PATCH
    return tl::unexpected(refusal);
  }
  return kept;
}

}  // namespace driftlab::cli
