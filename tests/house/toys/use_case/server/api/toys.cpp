#include "server/api/api.hpp"
#include "server/api/documents.hpp"

namespace driftlab::server {
namespace {

Result<Response> get_toy(ApiContext& context, const Request& request) {
  const auto job = context.store.job(request.parameters[0]);
  if (!job || job->kind != "toy") {
    return fail(job ? Error{ErrorCode::NotFound, "The job is no toy."} : job.error());
  }
  auto document = context.store.result_document(job->id);
  if (!document) {
    return fail(document.error());
  }
  return json_response(200, stored(*document));
}

}  // namespace

void add_toy_routes(Router& router, ApiContext& context) {
  router.add({"GET", "/v1/toys/{id}", "getToy", {}, Handler([&](const Request& request) {
                return get_toy(context, request);
              })});
}

}  // namespace driftlab::server
