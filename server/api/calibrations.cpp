#include "core/analysis/calibrate.hpp"
#include "schema/json/calibration.hpp"
#include "server/api/api.hpp"
#include "server/api/documents.hpp"
#include "server/jobs/stored_recordings.hpp"
#include "server/store/digest.hpp"

namespace driftlab::server {
namespace {

constexpr std::size_t kMostRecordings = 100;
constexpr double kLeastGravity = 9.7;  // the earth's surface has 9.764 to 9.834 m/s^2
constexpr double kMostGravity = 9.9;

Json to_json(const StoredCalibration& calibration) {
  Json document = stored(calibration.document_json);
  document["id"] = calibration.id;
  document["device"] = calibration.device_id;
  document["created_at"] = rfc3339(calibration.created_at);
  return document;
}

/// What a POST asks for.
struct Wanted {
  std::string device;
  std::vector<std::string> recordings;
  Json calibration;  ///< one made elsewhere, or null
  CalibrateOptions options;
};

std::vector<std::string> listed(const Json& list, Faults& faults) {
  std::vector<std::string> ids;
  if (!list.is_array() || list.empty() || list.size() > kMostRecordings) {
    faults.add("/recordings", ErrorCode::InvalidArgument, "Name 1 to 100 recordings by their ids.");
    return ids;
  }
  for (std::size_t i = 0; i < list.size(); ++i) {
    const std::string id = list[i].is_string() ? list[i].get<std::string>() : "";
    if (!is_id(id, "rec") || std::find(ids.begin(), ids.end(), id) != ids.end()) {
      faults.add("/recordings/" + std::to_string(i), ErrorCode::InvalidArgument,
                 "Name each recording once, by its id: rec_01H….");
    }
    ids.push_back(id);
  }
  return ids;
}

Result<Wanted> read_wanted(const Request& request) {
  auto body = parse_json(request.body);
  if (!body) {
    return fail(body.error());
  }
  Faults faults;
  Wanted wanted;
  ObjectReader reader(*body, "", faults);
  if (const Json* const device = reader.member("device"); device != nullptr) {
    ObjectReader named(*device, "/device", faults);
    wanted.device = named.required_text("id");
    named.reject_unknown();
  } else {
    faults.add("/device/id", ErrorCode::InvalidArgument, "Name the device of the calibration.");
  }
  const Json* const recordings = reader.member("recordings");
  const Json* const calibration = reader.member("calibration");
  if ((recordings == nullptr) == (calibration == nullptr)) {
    faults.add("/recordings", ErrorCode::InvalidArgument,
               "Give either recordings to calibrate from, or a calibration made elsewhere.");
  } else if (recordings != nullptr) {
    wanted.recordings = listed(*recordings, faults);
  } else {
    (void)calibration_from_json(*calibration, "/calibration", faults);
    wanted.calibration = *calibration;
  }
  wanted.options.gravity_m_s2 = reader.real("gravity_m_s2").value_or(kStandardGravity);
  if (!(wanted.options.gravity_m_s2 >= kLeastGravity && wanted.options.gravity_m_s2 <= kMostGravity)) {
    faults.add("/gravity_m_s2", ErrorCode::InvalidArgument, "Gravity lies between 9.7 and 9.9 m/s^2.");
  }
  if (const Json* const misalignment = reader.member("misalignment")) {
    if (!misalignment->is_boolean()) {
      faults.add("/misalignment", ErrorCode::ParseError, "This member must be true or false.");
    } else {
      wanted.options.misalignment = misalignment->get<bool>();
    }
  }
  reader.reject_unknown();
  return faults.none() ? Result<Wanted>(std::move(wanted)) : fail(faults.error());
}

/// The recordings of a POST, which must be the device's own; errors point into the request.
class ListedRecordings final : public StoredRecordings {
 public:
  ListedRecordings(ApiContext& context, std::vector<StoredRecordingRequest> wanted, const Device& device)
      : StoredRecordings(context.store, context.blobs, std::move(wanted), context.verify_columns), device_(device) {}

  [[nodiscard]] Error located(std::size_t index, Error error) const override {
    const std::string sentence = error.message;
    return std::move(error).with("/recordings/" + std::to_string(index), sentence);
  }

 protected:
  [[nodiscard]] Status admit(const Recording& row) const override {
    if (row.device_id != device_.id) {
      return fail(ErrorCode::InvalidArgument,
                  "The recording " + row.id + " belongs to another device than " + device_.name + ".");
    }
    return {};
  }

 private:
  const Device& device_;
};

/// Calibrates from uploaded recordings; `used` gets each with its revision.
Result<Json> calibrate_stored(ApiContext& context, const Wanted& wanted, const Device& device, Json& used) {
  std::vector<StoredRecordingRequest> list;
  for (const std::string& id : wanted.recordings) {
    list.push_back({id, std::nullopt, ""});
  }
  ListedRecordings recordings(context, std::move(list), device);
  auto report = calibrate(recordings, wanted.options);
  if (!report) {
    return fail(report.error());
  }
  for (std::size_t i = 0; i < recordings.count(); ++i) {
    used.push_back(Json{{"id", recordings.row(i).id}, {"revision", recordings.row(i).revision}});
  }
  return driftlab::to_json(*report);
}

Result<Response> create_calibration(ApiContext& context, const Request& request) {
  auto wanted = read_wanted(request);
  if (!wanted) {
    return fail(wanted.error());
  }
  Device named;
  named.name = wanted->device;
  // A calibration made elsewhere may come before the first recording of its device.
  Result<Device> device = fail(ErrorCode::NotFound, "");
  if (wanted->recordings.empty()) {
    auto ensured = context.store.ensure_device(named);
    device = ensured ? Result<Device>(ensured->device) : fail(ensured.error());
  } else {
    device = context.store.device(wanted->device);
  }
  if (!device) {
    return fail(device.error());
  }
  Json document{{"recordings", Json::array()}, {"calibration", wanted->calibration}};
  if (!wanted->recordings.empty()) {
    auto made = calibrate_stored(context, *wanted, *device, document["recordings"]);
    if (!made) {
      return fail(made.error());
    }
    document["calibration"] = std::move(*made);
    document["gravity_m_s2"] = wanted->options.gravity_m_s2;
    document["misalignment"] = wanted->options.misalignment;
  }
  StoredCalibration calibration;
  calibration.device_id = device->id;
  calibration.document_json = canonical_text(document);
  calibration.unique_key = sha256_hex(device->id + calibration.document_json);
  auto outcome = context.store.add_calibration(calibration);
  if (!outcome) {
    return fail(outcome.error());
  }
  Response response = json_response(outcome->created ? 201 : 200, to_json(outcome->calibration));
  response.headers.emplace_back("Location", "/v1/calibrations/" + outcome->calibration.id);
  return response;
}

Result<Response> list_calibrations(ApiContext& context, const Request& request) {
  auto device_id = device_filter(context.store, request);
  if (!device_id) {
    return fail(device_id.error());
  }
  return list_rows(
      request, [&](const Page& page) { return context.store.calibrations(*device_id, page); },
      [](const StoredCalibration& calibration) { return to_json(calibration); });
}

Result<Response> get_calibration(ApiContext& context, const Request& request) {
  auto calibration = context.store.calibration(request.parameters[0]);
  if (!calibration) {
    return fail(calibration.error());
  }
  return json_response(200, to_json(*calibration));
}

Result<Response> delete_calibration(ApiContext& context, const Request& request) {
  return remove_shown(request, get_calibration(context, request),
                      [&] { return context.store.remove_calibration(request.parameters[0]); });
}

}  // namespace

void add_calibration_routes(Router& router, ApiContext& context) {
  router.add({"GET",
              "/v1/calibrations",
              "listCalibrations",
              {"limit", "cursor", "sort", "device"},
              Handler([&](const Request& request) { return list_calibrations(context, request); })});
  router.add({"POST", "/v1/calibrations", "createCalibration", {}, Handler([&](const Request& request) {
                return create_calibration(context, request);
              })});
  router.add({"GET", "/v1/calibrations/{id}", "getCalibration", {}, Handler([&](const Request& request) {
                return get_calibration(context, request);
              })});
  router.add({"DELETE", "/v1/calibrations/{id}", "deleteCalibration", {}, Handler([&](const Request& request) {
                return delete_calibration(context, request);
              })});
}

}  // namespace driftlab::server
