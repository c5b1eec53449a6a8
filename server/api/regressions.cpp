#include "server/api/api.hpp"
#include "server/api/documents.hpp"

namespace driftlab::server {
namespace {

/// A run is its job; its document is the job's result.
Json listed(ApiContext& context, const Job& job) {
  Json item{{"id", job.id},         {"state", name_of(job.state)},
            {"device", nullptr},    {"baseline", nullptr},
            {"candidate", nullptr}, {"verdict", nullptr},
            {"summary", nullptr},   {"look", nullptr},
            {"needs", nullptr},     {"created_at", rfc3339(job.created_at)}};
  const Json request = stored(job.request_json);
  if (request.is_object()) {
    item["device"] = request["inputs"]["device"];
    item["baseline"] = request["inputs"]["baseline"]["label"];
    item["candidate"] = request["inputs"]["candidate"]["label"];
    item["look"] = request["look"]["number"];
  }
  if (job.state == JobState::Succeeded) {
    if (const auto text = context.store.result_document(job.id)) {
      const Json document = stored(*text);
      item["verdict"] = document["verdict"];
      item["summary"] = document["summary"];
      item["needs"] = document["needs"];
    }
  }
  return item;
}

Result<Response> list_regressions(ApiContext& context, const Request& request) {
  return list_rows(
      request, [&](const Page& page) { return context.store.jobs({std::string("regress"), std::nullopt}, page); },
      [&](const Job& job) { return listed(context, job); });
}

Result<Response> get_regression(ApiContext& context, const Request& request) {
  const auto job = context.store.job(request.parameters[0]);
  if (!job) {
    return fail(job.error());
  }
  if (job->kind != "regress") {
    return fail(ErrorCode::NotFound, "The job " + job->id + " is no regression run.", {{"job", job->id}});
  }
  auto document = context.store.result_document(job->id);
  if (!document) {
    return fail(document.error());
  }
  return json_response(200, stored(*document));
}

}  // namespace

void add_regression_routes(Router& router, ApiContext& context) {
  router.add(
      {"GET", "/v1/regressions", "listRegressions", {"limit", "cursor", "sort"}, Handler([&](const Request& request) {
         return list_regressions(context, request);
       })});
  router.add({"GET", "/v1/regressions/{id}", "getRegression", {}, Handler([&](const Request& request) {
                return get_regression(context, request);
              })});
}

}  // namespace driftlab::server
