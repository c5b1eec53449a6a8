// Noise parameters of a device in the files of other programs.
#include "schema/json/json.hpp"
#include "schema/text/export.hpp"
#include "server/api/api.hpp"
#include "server/api/documents.hpp"
#include "server/http/problem.hpp"
#include "server/jobs/stored_noise.hpp"

namespace driftlab::server {
namespace {

Json target_json(const ExportTarget& target) {
  return Json{{"target", target.name},
              {"title", target.title},
              {"file", target.file},
              {"convention", target.convention},
              {"source", target.source}};
}

Result<Response> list_targets(const Request&) {
  Json targets = Json::array();
  for (const ExportTarget& target : export_targets()) {
    targets.push_back(target_json(target));
  }
  return json_response(200, Json{{"items", std::move(targets)}, {"next_cursor", nullptr}});
}

Result<Response> get_export(ApiContext& context, const Request& request) {
  const auto type = negotiate(request.header("accept"), {"text/plain", "application/json"});
  if (!type) {
    return problem_response(HttpFault::NotAcceptable, "Offered are text/plain and application/json.");
  }
  const auto target = find_export_target(request.parameters[0]);
  if (!target) {
    return fail(ErrorCode::NotFound, target.error().message);
  }
  const auto device = request.parameter("device");
  if (!device || device->empty()) {
    return fail(ErrorCode::InvalidArgument, "Name the device: ?device=…", {{"parameter", "device"}});
  }
  const auto imu = stored_noise(context.store, std::string(*device));
  if (!imu) {
    return fail(imu.error());
  }
  const std::string text = export_to_text(**target, *imu);
  if (*type == "application/json") {
    Json document = target_json(**target);
    document["device"] = imu->device;
    document["recordings"] = imu->recordings;
    document["gaps"] = export_gaps(**target, *imu);
    document["text"] = text;
    Response response = json_response(200, document);
    response.headers.emplace_back("Vary", "Accept");
    return response;
  }
  Response response;
  response.status = 200;
  response.content_type = "text/plain; charset=utf-8";
  response.body = text;
  response.headers.emplace_back("Vary", "Accept");
  response.headers.emplace_back("Content-Disposition", "inline; filename=\"" + std::string((*target)->file) + "\"");
  return response;
}

}  // namespace

void add_export_routes(Router& router, ApiContext& context) {
  router.add(
      {"GET", "/v1/exports", "listExportTargets", {}, Handler([](const Request& r) { return list_targets(r); })});
  router.add({"GET", "/v1/exports/{target}", "getExport", {"device"}, Handler([&](const Request& r) {
                return get_export(context, r);
              })});
}

}  // namespace driftlab::server
