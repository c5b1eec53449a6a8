#include "server/api/upload_metadata.hpp"

#include "core/signal/number.hpp"
#include "schema/json/recording_spec.hpp"
#include "schema/json/regression.hpp"
#include "server/api/device_name.hpp"
#include "server/api/documents.hpp"

#include <algorithm>
#include <utility>

namespace driftlab::server {
namespace {

std::optional<std::string> text_of(const Request& request, std::string_view name) {
  const auto value = request.parameter(name);
  return value ? std::optional<std::string>(*value) : std::nullopt;
}

Result<std::optional<double>> number_of(const Request& request, std::string_view name, bool zero_is_fine) {
  const auto text = request.parameter(name);
  if (!text) {
    return std::optional<double>();
  }
  const auto value = parse_double(*text);
  const bool sound = value && *value < 1e300 && (zero_is_fine ? *value >= 0.0 : *value > 0.0);
  if (!sound) {
    return fail(ErrorCode::InvalidArgument,
                "The parameter " + std::string(name) + " must be a number " +
                    (zero_is_fine ? "of at least 0" : "greater than 0") + ", not '" + std::string(*text) + "'.",
                {{"parameter", std::string(name)}});
  }
  return value;
}

tl::unexpected<Error> at(const Error& error, std::string parameter) {
  for (const ErrorField& field : error.fields) {
    if (field.name == "parameter") {
      return fail(error);
    }
  }
  return fail(Error(error).with("parameter", std::move(parameter)));
}

Result<Condition> condition_of(const Request& request) {
  const auto text = request.parameter("condition");
  if (!text || text->empty()) {
    return fail(ErrorCode::InvalidArgument,
                "Name the dynamic condition, for example condition=static or condition=constant_rate:z:9:deg/s.",
                {{"parameter", "condition"}});
  }
  if (text->find(':') != std::string_view::npos) {
    return parse_condition(*text);
  }
  WrittenCondition written;
  written.kind = *text;
  written.axis = text_of(request, "axis");
  written.unit = text_of(request, "unit");
  written.direction = text_of(request, "direction");
  if (const auto value = request.parameter("value")) {
    written.value = parse_double(*value);
    if (!written.value) {
      return fail(ErrorCode::InvalidArgument, "The value must be a number, not '" + std::string(*value) + "'.",
                  {{"parameter", "value"}});
    }
  }
  return make_condition(written);
}

Status check_device_name(const std::string& name) {
  if (name.empty()) {
    return fail(ErrorCode::InvalidArgument, "Name the device that made the recording: ?device=…",
                {{"parameter", "device"}});
  }
  if (std::string fault = fault_of_device_name(name); !fault.empty()) {
    return fail(ErrorCode::InvalidArgument, std::move(fault), {{"parameter", "device"}});
  }
  return {};
}

void read_device(const Json& document, Device& device, const Budgets& budgets, Faults& faults) {
  if (document.is_string()) {
    device.name = document.get<std::string>();
    return;
  }
  ObjectReader reader(document, "/device", faults);
  device.name = reader.required_text("id");
  device.model = reader.text("model").value_or("");
  device.imu = reader.text("imu").value_or("");
  device.serial = reader.text("serial").value_or("");
  for (const auto& [member, text] :
       {std::pair{"model", &device.model}, std::pair{"imu", &device.imu}, std::pair{"serial", &device.serial}}) {
    limit_text(*text, "name_bytes", budgets.name_bytes, reader.pointer(member), faults);
  }
  reader.reject_unknown();
}

/// Labels, session and time.
Status tags_from_query(const Request& request, RecordingTags& tags) {
  if (const auto text = request.parameter("labels"); text && !text->empty()) {
    auto labels = parse_labels(*text);
    if (!labels) {
      return fail(labels.error());
    }
    tags.labels = std::move(*labels);
  }
  tags.session = request.parameter("session").value_or("");
  tags.recorded_at = request.parameter("recorded_at").value_or("");
  if (!tags.recorded_at.empty()) {
    if (const auto time = seconds_of(tags.recorded_at); !time) {
      return fail(time.error());
    }
  }
  Faults faults;
  limit_tags(tags, *request.budgets, "", faults);
  return faults.none() ? Status{} : fail(faults.error());
}

}  // namespace

std::string shown_file_name(std::string_view name) {
  constexpr std::size_t kLongest = 255;
  const std::size_t folder = name.find_last_of("/\\");
  std::string shown(folder == std::string_view::npos ? name : name.substr(folder + 1));
  std::erase_if(shown, [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F; });
  std::size_t end = std::min(shown.size(), kLongest);
  while (end < shown.size() && end > 0 && (static_cast<unsigned char>(shown[end]) & 0xC0U) == 0x80U) {
    --end;  // a character is kept whole
  }
  shown.resize(end);
  return is_plain_text(shown) ? shown : std::string();
}

void limit_tags(const RecordingTags& tags, const Budgets& budgets, const std::string& pointer, Faults& faults) {
  if (tags.labels.size() > static_cast<std::size_t>(budgets.labels)) {
    faults.add(pointer + "/labels", ErrorCode::LimitExceeded,
               "These are too many labels " + naming_budget("labels", budgets.labels) + ".");
  }
  for (const auto& [name, value] : tags.labels) {
    limit_text(name, "label_bytes", budgets.label_bytes, pointer + "/labels", faults);
    limit_text(value, "label_bytes", budgets.label_bytes, pointer + "/labels", faults);
  }
  limit_text(tags.session, "name_bytes", budgets.name_bytes, pointer + "/session", faults);
}

void limit_names(const RecordingSpec& spec, const Budgets& budgets, const std::string& pointer, Faults& faults,
                 const Json* given) {
  const auto is_given = [given](const char* member) { return given == nullptr || given->contains(member); };
  for (const auto& [member, text] :
       {std::pair{"id", &spec.id}, std::pair{"stream", &spec.stream}, std::pair{"calibration", &spec.calibration}}) {
    if (is_given(member)) {
      limit_text(*text, "name_bytes", budgets.name_bytes, pointer + "/" + member, faults);
    }
  }
  for (const auto& [name, role] : spec.columns) {
    if (is_given("columns")) {
      limit_text(name, "name_bytes", budgets.name_bytes, pointer + "/columns", faults);
    }
  }
}

Result<UploadMetadata> metadata_from_query(const Request& request) {
  UploadMetadata metadata;
  metadata.device.name = request.parameter("device").value_or("");
  if (auto checked = check_device_name(metadata.device.name); !checked) {
    return fail(checked.error());
  }
  auto condition = condition_of(request);
  if (!condition) {
    return at(condition.error(), "condition");
  }
  metadata.spec.condition = *condition;
  metadata.spec.id = request.parameter("id").value_or("");
  metadata.file_name = shown_file_name(request.parameter("file_name").value_or(""));
  metadata.spec.stream = request.parameter("stream").value_or("");
  metadata.spec.calibration = request.parameter("calibration").value_or("");
  auto rate = number_of(request, "rate_hz", false);
  auto start = number_of(request, "trim_start_s", true);
  auto end = number_of(request, "trim_end_s", true);
  for (const auto* const number : {&rate, &start, &end}) {
    if (!*number) {
      return fail(number->error());
    }
  }
  metadata.spec.rate_hz = *rate;
  metadata.spec.trim = {start->value_or(0.0), end->value_or(0.0)};
  if (const auto columns = request.parameter("columns"); columns && !columns->empty()) {
    auto roles = parse_columns(*columns);
    if (!roles) {
      return at(roles.error(), "columns");
    }
    metadata.spec.columns = std::move(*roles);
  }
  Faults faults;
  limit_names(metadata.spec, *request.budgets, "", faults);
  if (!faults.none()) {
    return fail(faults.error());
  }
  if (auto tagged = tags_from_query(request, metadata.tags); !tagged) {
    return fail(tagged.error());
  }
  return metadata;
}

Result<UploadMetadata> metadata_from_json(std::string_view text, const Request& request) {
  auto document = parse_json(text);
  if (!document) {
    return fail(Error(document.error()).with("part", "metadata"));
  }
  UploadMetadata metadata;
  Faults faults;
  Json recording = *document;
  if (recording.is_object() && recording.contains("device")) {
    read_device(recording["device"], metadata.device, *request.budgets, faults);
    recording.erase("device");
  }
  metadata.spec = recording_spec_from_json(recording, "", faults);
  limit_names(metadata.spec, *request.budgets, "", faults);
  Faults found_already;
  metadata.tags = recording_tags_from_json(recording, "", found_already);
  limit_tags(metadata.tags, *request.budgets, "", faults);
  if (!faults.none()) {
    return fail(Error(faults.error()).with("part", "metadata"));
  }
  if (const auto name = request.parameter("device")) {
    if (!metadata.device.name.empty() && metadata.device.name != *name) {
      return fail(ErrorCode::InvalidArgument, "The query and the metadata name different devices.",
                  {{"parameter", "device"}});
    }
    metadata.device.name = *name;
  }
  if (auto checked = check_device_name(metadata.device.name); !checked) {
    return fail(checked.error());
  }
  return metadata;
}

}  // namespace driftlab::server
