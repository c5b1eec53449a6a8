#include "server/api/api.hpp"
#include "server/api/documents.hpp"
#include "server/http/problem.hpp"

namespace driftlab::server {
namespace {

Json summary(const Investigation& row) {
  return Json{{"id", row.id},
              {"job", row.job_id},
              {"device", row.device_id},
              {"study", row.study_id},
              {"baseline_model", row.baseline_id},
              {"model", row.model_id},
              {"findings", stored(row.summary_json)},
              {"created_at", rfc3339(row.created_at)}};
}

Result<Response> list_investigations(ApiContext& context, const Request& request) {
  InvestigationFilter filter;
  auto device_id = device_filter(context.store, request);
  if (!device_id) {
    return fail(device_id.error());
  }
  filter.device_id = std::move(*device_id);
  if (const auto study = request.parameter("study")) {
    filter.study_id = *study;
  }
  if (const auto job = request.parameter("job")) {
    filter.job_id = *job;
  }
  auto sought = text_filter(request);
  auto since = since_filter(request);
  if (!sought || !since) {
    return fail(sought ? since.error() : sought.error());
  }
  filter.text = std::move(*sought);
  filter.since = *since;
  return list_rows(
      request, [&](const Page& page) { return context.store.investigations(filter, page); },
      [](const Investigation& row) { return summary(row); });
}

Result<Response> get_investigation(ApiContext& context, const Request& request) {
  const auto type = negotiate(request.header("accept"), {"application/json", "text/markdown"});
  if (!type) {
    return problem_response(HttpFault::NotAcceptable, "Offered are application/json and text/markdown.");
  }
  auto row = context.store.investigation(request.parameters[0]);
  if (!row) {
    return fail(row.error());
  }
  Response response;
  if (*type == "text/markdown") {
    response.content_type = "text/markdown; charset=utf-8";
    response.body = row->page;
  } else {
    auto report = context.store.result_document(row->job_id);
    if (!report) {
      return fail(report.error());
    }
    Json document = stored(*report);
    document["job"] = row->job_id;
    document["created_at"] = rfc3339(row->created_at);
    response = json_response(200, document);
  }
  response.headers.emplace_back("Vary", "Accept");
  return response;
}

Result<Response> delete_investigation(ApiContext& context, const Request& request) {
  return remove_shown(request, get_investigation(context, request),
                      [&] { return context.store.remove_investigation(request.parameters[0]); });
}

}  // namespace

void add_investigation_routes(Router& router, ApiContext& context) {
  router.add({"GET",
              "/v1/investigations",
              "listInvestigations",
              {"limit", "cursor", "sort", "device", "study", "job", "q", "since"},
              Handler([&](const Request& request) { return list_investigations(context, request); })});
  router.add(from_rows({"GET", "/v1/investigations/{id}", "getInvestigation", {}, Handler([&](const Request& request) {
                          return get_investigation(context, request);
                        })}));
  router.add({"DELETE", "/v1/investigations/{id}", "deleteInvestigation", {}, Handler([&](const Request& request) {
                return delete_investigation(context, request);
              })});
}

}  // namespace driftlab::server
