#include "schema/json/parameter_table.hpp"
#include "schema/json/trend_table.hpp"
#include "schema/text/parameter_table.hpp"
#include "schema/text/trend_table.hpp"
#include "server/api/api.hpp"
#include "server/api/documents.hpp"
#include "server/http/problem.hpp"
#include "server/jobs/stored_table.hpp"

namespace driftlab::server {
namespace {

/// The table that a request asks for, from stored results alone.
Result<ParameterTable> read_table(ApiContext& context, const Request& request) {
  const auto name = request.parameter("device");
  if (!name || name->empty()) {
    return fail(ErrorCode::InvalidArgument, "Name the device: ?device=…", {{"parameter", "device"}});
  }
  StoredTableRequest wanted;
  wanted.device = *name;
  wanted.sensor = request.parameter("sensor").value_or(wanted.sensor);
  wanted.axis = request.parameter("axis").value_or("");
  wanted.method = request.parameter("method").value_or(wanted.method);
  wanted.model = request.parameter("model").value_or("");
  return stored_table(context.store, wanted);
}

Result<Response> get_table(ApiContext& context, const Request& request) {
  const auto type =
      negotiate(request.header("accept"), {"application/json", "text/csv", "text/plain", "text/markdown"});
  if (!type) {
    return problem_response(HttpFault::NotAcceptable,
                            "Offered are application/json, text/csv, text/plain and text/markdown.");
  }
  auto table = read_table(context, request);
  if (!table) {
    return fail(table.error());
  }
  Response response = json_response(200, to_json(*table));
  response.headers.emplace_back("Vary", "Accept");
  if (*type == "text/csv") {
    response.content_type = "text/csv; charset=utf-8";
    response.body = table_to_csv(*table);
  } else if (*type == "text/plain") {
    response.content_type = "text/plain; charset=utf-8";
    response.body = table_to_text(*table);
  } else if (*type == "text/markdown") {
    response.content_type = "text/markdown; charset=utf-8";
    response.body = table_to_markdown(*table);
  }
  return response;
}

Result<Response> get_trends(ApiContext& context, const Request& request) {
  const auto type = negotiate(request.header("accept"), {"application/json", "text/plain"});
  if (!type) {
    return problem_response(HttpFault::NotAcceptable, "Offered are application/json and text/plain.");
  }
  auto table = read_table(context, request);
  if (!table) {
    return fail(table.error());
  }
  const TrendTable trends = build_trends(*table);
  Response response = json_response(200, to_json(trends));
  response.headers.emplace_back("Vary", "Accept");
  if (*type == "text/plain") {
    response.content_type = "text/plain; charset=utf-8";
    response.body = trends_to_text(trends);
  }
  return response;
}

}  // namespace

void add_parameter_table_routes(Router& router, ApiContext& context) {
  router.add({"GET",
              "/v1/parameter-tables",
              "getParameterTable",
              {"device", "sensor", "axis", "method", "model"},
              Handler([&](const Request& request) { return get_table(context, request); })});
  router.add({"GET",
              "/v1/trends",
              "getTrends",
              {"device", "sensor", "axis", "method", "model"},
              Handler([&](const Request& request) { return get_trends(context, request); })});
}

}  // namespace driftlab::server
