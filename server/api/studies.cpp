#include "schema/json/recording_spec.hpp"
#include "server/api/api.hpp"
#include "server/api/device_name.hpp"
#include "server/api/documents.hpp"
#include "server/store/digest.hpp"

namespace driftlab::server {
namespace {

constexpr std::size_t kMostRecordings = 100;

Json to_json(const Study& study) {
  return Json{{"id", study.id},
              {"device", study.device_id},
              {"study", stored(study.document_json)},
              {"created_at", rfc3339(study.created_at)}};
}

/// What the study says about a recording must be what the store says: it is not the place to change it.
void check_metadata(const Json& entry, const Recording& recording, const std::string& pointer, Faults& faults) {
  const Json metadata = stored(recording.metadata_json);
  Json whole = metadata;
  for (const auto& [member, value] : entry.items()) {
    whole[member] = value;
  }
  const Json said_document = driftlab::to_json(recording_spec_from_json(whole, pointer, faults));
  for (const char* const member : {"condition", "trim", "rate_hz", "columns", "stream", "calibration"}) {
    if (entry.contains(member) && said_document.value(member, Json()) != metadata.value(member, Json())) {
      faults.add(pointer + "/" + member, ErrorCode::Conflict,
                 "The recording " + recording.id + " has another " + member +
                     "; leave it out, or change it with PATCH /v1/recordings/" + recording.id + ".");
    }
  }
}

/// One member of `recordings`: by id, with what the study says checked against what is stored.
void read_recording(ApiContext& context, const Json& entry, const std::string& pointer, const Device& device,
                    std::vector<std::string>& ids, Faults& faults) {
  ObjectReader reader(entry, pointer, faults);
  const std::string id = reader.required_text("recording");
  if (id.empty()) {
    return;
  }
  auto recording = is_id(id, "rec") ? context.store.recording(id) : fail(ErrorCode::NotFound, "");
  if (!recording) {
    faults.add(pointer + "/recording", ErrorCode::NotFound, "There is no recording " + id + ".");
    return;
  }
  if (recording->device_id != device.id) {
    faults.add(pointer + "/recording", ErrorCode::InvalidArgument,
               "The recording " + id + " belongs to another device than " + device.name + ".");
    return;
  }
  if (std::find(ids.begin(), ids.end(), id) != ids.end()) {
    faults.add(pointer + "/recording", ErrorCode::InvalidArgument, "The recording " + id + " is named twice.");
    return;
  }
  ids.push_back(id);
  Json rest = entry;
  rest.erase("recording");
  check_metadata(rest, *recording, pointer, faults);
}

Result<Response> create_study(ApiContext& context, const Request& request) {
  auto body = parse_json(request.body);
  if (!body) {
    return fail(body.error());
  }
  Faults faults;
  ObjectReader reader(*body, "", faults);
  const Json* const device_member = reader.member("device");
  const Json* const recordings = reader.member("recordings");
  const Json* const labels = reader.member("labels");
  const Json* const baseline = reader.member("baseline");
  reader.reject_unknown();
  const bool named = device_member != nullptr && device_member->is_object() && device_member->contains("id") &&
                     (*device_member)["id"].is_string();
  if (!named) {
    return fail(ErrorCode::InvalidArgument, "Name the device of the study: device.id.", {{"pointer", "/device/id"}});
  }
  ObjectReader device_reader(*device_member, "/device", faults);
  const std::string device_name = device_reader.required_text("id");
  for (const char* const told : {"model", "imu", "serial"}) {
    (void)device_reader.text(told);  // for people; the device has its own
  }
  device_reader.reject_unknown();
  if (std::string fault = fault_of_device_name(device_name); !fault.empty()) {
    return fail(ErrorCode::InvalidArgument, std::move(fault), {{"pointer", "/device/id"}});
  }
  auto device = context.store.device(device_name);
  if (!device) {
    return fail(device.error());
  }
  if ((labels != nullptr && !labels->is_object()) || (baseline != nullptr && !baseline->is_object())) {
    faults.add(labels != nullptr && !labels->is_object() ? "/labels" : "/baseline", ErrorCode::ParseError,
               "This member must be an object.");
  }
  std::vector<std::string> ids;
  if (recordings == nullptr || !recordings->is_array() || recordings->empty() || recordings->size() > kMostRecordings) {
    faults.add("/recordings", ErrorCode::InvalidArgument, "A study has 1 to 100 recordings, each named by its id.");
  } else {
    for (std::size_t i = 0; i < recordings->size(); ++i) {
      read_recording(context, (*recordings)[i], "/recordings/" + std::to_string(i), *device, ids, faults);
    }
  }
  if (!faults.none()) {
    return fail(faults.error());
  }
  Study study;
  study.device_id = device->id;
  study.document_json = canonical_text(*body);
  study.unique_key = sha256_hex(device->id + study.document_json);
  auto outcome = context.store.add_study(study);
  if (!outcome) {
    return fail(outcome.error());
  }
  Response response = json_response(outcome->created ? 201 : 200, to_json(outcome->study));
  response.headers.emplace_back("Location", "/v1/studies/" + outcome->study.id);
  return response;
}

Result<Response> list_studies(ApiContext& context, const Request& request) {
  auto device_id = device_filter(context.store, request);
  if (!device_id) {
    return fail(device_id.error());
  }
  return list_rows(
      request, [&](const Page& page) { return context.store.studies(*device_id, page); },
      [](const Study& study) { return to_json(study); });
}

Result<Response> get_study(ApiContext& context, const Request& request) {
  auto study = context.store.study(request.parameters[0]);
  if (!study) {
    return fail(study.error());
  }
  return json_response(200, to_json(*study));
}

Result<Response> delete_study(ApiContext& context, const Request& request) {
  return remove_shown(request, get_study(context, request),
                      [&] { return context.store.remove_study(request.parameters[0]); });
}

}  // namespace

void add_study_routes(Router& router, ApiContext& context) {
  router.add(
      {"GET", "/v1/studies", "listStudies", {"limit", "cursor", "sort", "device"}, Handler([&](const Request& request) {
         return list_studies(context, request);
       })});
  router.add({"POST", "/v1/studies", "createStudy", {}, Handler([&](const Request& request) {
                return create_study(context, request);
              })});
  router.add({"GET", "/v1/studies/{id}", "getStudy", {}, Handler([&](const Request& request) {
                return get_study(context, request);
              })});
  router.add({"DELETE", "/v1/studies/{id}", "deleteStudy", {}, Handler([&](const Request& request) {
                return delete_study(context, request);
              })});
}

}  // namespace driftlab::server
