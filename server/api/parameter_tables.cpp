#include "schema/json/parameter_table.hpp"
#include "schema/json/trend_table.hpp"
#include "server/api/api.hpp"
#include "server/api/documents.hpp"
#include "server/http/problem.hpp"

namespace driftlab::server {
namespace {

Result<TableRequest> table_request(const Request& request, const Device& device) {
  TableRequest table;
  table.device = device.name;
  auto quantity = quantity_of_sensor(request.parameter("sensor").value_or("gyroscope"));
  if (!quantity) {
    return fail(Error(quantity.error()).with("parameter", "sensor"));
  }
  table.quantity = *quantity;
  table.axis = request.parameter("axis").value_or("");
  if (!table.axis.empty() && !is_axis_of(table.axis, table.quantity)) {
    return fail(ErrorCode::InvalidArgument, "The axis must be x, y or z, not '" + table.axis + "'.",
                {{"parameter", "axis"}});
  }
  auto method = parse_table_method(request.parameter("method").value_or("gmwm"));
  if (!method) {
    return fail(method.error());
  }
  table.method = *method;
  table.model = request.parameter("model").value_or("");
  return table;
}

/// The table that a request asks for, from stored results alone.
Result<Json> read_table(ApiContext& context, const Request& request) {
  const auto name = request.parameter("device");
  if (!name || name->empty()) {
    return fail(ErrorCode::InvalidArgument, "Name the device: ?device=…", {{"parameter", "device"}});
  }
  auto device = context.store.device(*name);
  if (!device) {
    return fail(device.error());
  }
  auto wanted = table_request(request, *device);
  if (!wanted) {
    return fail(wanted.error());
  }
  const std::string_view quantity = driftlab::name_of(wanted->quantity);
  auto rows = context.store.latest_channel_results(device->id, quantity, wanted->axis);
  if (!rows) {
    return fail(rows.error());
  }
  auto pooled = context.store.pooled_result(device->id, quantity, wanted->axis);
  if (!pooled) {
    return fail(pooled.error());
  }
  std::vector<TableSource> sources;
  for (const ChannelResult& row : *rows) {
    sources.push_back({row.recording_id, row.condition, stored(row.document_json), row.id});
  }
  const Json together = *pooled ? stored((*pooled)->document_json) : Json();
  return build_parameter_table(*wanted, sources, together.is_object() ? &together : nullptr);
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
  Response response = json_response(200, *table);
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
  const Json trends = build_trends(*table);
  Response response = json_response(200, trends);
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
