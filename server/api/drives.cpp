/// Drives: documents over uploaded recordings, checked when they are stored.
#include "server/api/api.hpp"
#include "server/api/documents.hpp"
#include "server/jobs/stored_drive.hpp"
#include "server/store/digest.hpp"

namespace driftlab::server {
namespace {

Json to_json(const StoredDrive& drive) {
  const Json document = stored(drive.document_json);
  return Json{{"id", drive.id},
              {"device", drive.device_id},
              {"name", document.value("id", "")},
              {"vehicle", document.value("vehicle", "")},
              {"drive", document},
              {"created_at", rfc3339(drive.created_at)}};
}

Result<Response> create_drive(ApiContext& context, const Request& request) {
  auto body = parse_json(request.body);
  if (!body) {
    return fail(body.error());
  }
  Faults faults;
  for (const std::string member : {"id", "vehicle"}) {
    if (body->is_object() && body->contains(member) && (*body)[member].is_string()) {
      limit_text((*body)[member].get<std::string>(), "name_bytes", request.budgets->name_bytes, "/" + member, faults);
    }
  }
  auto checked = check_stored_drive(*body, "", context.store, faults);
  if (!checked) {
    return refused_job(checked.error());
  }
  if (!faults.none()) {
    return fail(faults.error());
  }
  StoredDrive drive;
  drive.device_id = checked->device_id;
  drive.document_json = canonical_text(*body);
  drive.unique_key = sha256_hex(drive.device_id + drive.document_json);
  auto outcome = context.store.add_drive(drive);
  if (!outcome) {
    return fail(outcome.error());
  }
  Response response = json_response(outcome->created ? 201 : 200, to_json(outcome->drive));
  response.headers.emplace_back("Location", "/v1/drives/" + outcome->drive.id);
  return response;
}

Result<Response> list_drives(ApiContext& context, const Request& request) {
  auto device_id = device_filter(context.store, request);
  if (!device_id) {
    return fail(device_id.error());
  }
  return list_rows(
      request, [&](const Page& page) { return context.store.drives(*device_id, page); },
      [](const StoredDrive& drive) { return to_json(drive); });
}

Result<Response> get_drive(ApiContext& context, const Request& request) {
  auto drive = context.store.drive(request.parameters[0]);
  if (!drive) {
    return fail(drive.error());
  }
  return json_response(200, to_json(*drive));
}

Result<Response> delete_drive(ApiContext& context, const Request& request) {
  return remove_shown(request, get_drive(context, request),
                      [&] { return context.store.remove_drive(request.parameters[0]); });
}

}  // namespace

void add_drive_routes(Router& router, ApiContext& context) {
  router.add(
      {"GET", "/v1/drives", "listDrives", {"limit", "cursor", "sort", "device"}, Handler([&](const Request& request) {
         return list_drives(context, request);
       })});
  router.add({"POST", "/v1/drives", "createDrive", {}, Handler([&](const Request& request) {
                return create_drive(context, request);
              })});
  router.add({"GET", "/v1/drives/{id}", "getDrive", {}, Handler([&](const Request& request) {
                return get_drive(context, request);
              })});
  router.add({"DELETE", "/v1/drives/{id}", "deleteDrive", {}, Handler([&](const Request& request) {
                return delete_drive(context, request);
              })});
}

}  // namespace driftlab::server
