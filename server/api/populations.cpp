// All devices of a model, parameter by parameter.
#include "core/campaign/population_verdict.hpp"
#include "schema/json/population.hpp"
#include "schema/text/population.hpp"
#include "server/api/api.hpp"
#include "server/api/documents.hpp"
#include "server/http/problem.hpp"
#include "server/jobs/stored_population.hpp"

namespace driftlab::server {
namespace {

Result<Response> get_populations(ApiContext& context, const Request& request) {
  const auto type =
      negotiate(request.header("accept"), {"application/json", "text/csv", "text/plain", "text/markdown"});
  if (!type) {
    return problem_response(HttpFault::NotAcceptable,
                            "Offered are application/json, text/csv, text/plain and text/markdown.");
  }
  const auto model = request.parameter("model");
  if (!model || model->empty()) {
    return fail(ErrorCode::InvalidArgument, "Name the model: ?model=…", {{"parameter", "model"}});
  }
  std::optional<Quantity> quantity;
  if (const auto sensor = request.parameter("sensor")) {
    const auto known = quantity_of_sensor(*sensor);
    if (!known) {
      return fail(Error(known.error()).with("parameter", "sensor"));
    }
    quantity = *known;
  }
  const auto report = stored_populations(context.store, std::string(*model), quantity);
  if (!report) {
    return fail(report.error());
  }
  Response response = json_response(200, driftlab::to_json(*report, verdict_of(*report)));
  if (*type == "text/csv") {
    response.content_type = "text/csv; charset=utf-8";
    response.body = populations_to_csv(*report);
  } else if (*type == "text/plain") {
    response.content_type = "text/plain; charset=utf-8";
    response.body = populations_to_text(*report);
  } else if (*type == "text/markdown") {
    response.content_type = "text/markdown; charset=utf-8";
    response.body = populations_to_markdown(*report);
  }
  response.headers.emplace_back("Vary", "Accept");
  return response;
}

}  // namespace

void add_population_routes(Router& router, ApiContext& context) {
  router.add(
      from_rows({"GET", "/v1/populations", "getPopulations", {"model", "sensor"}, Handler([&](const Request& request) {
                   return get_populations(context, request);
                 })}));
}

}  // namespace driftlab::server
