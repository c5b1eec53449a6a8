#include "schema/text/parameter_table.hpp"
#include "schema/text/trend_table.hpp"
#include "server/api/api.hpp"
#include "server/api/documents.hpp"
#include "server/http/problem.hpp"
#include "server/jobs/kept_table.hpp"

namespace driftlab::server {
namespace {

constexpr std::string_view kJobs = "/v1/jobs/";

Json to_json(const AxisPooling& pooling) {
  return Json{{"state", name_of(pooling.state)},
              {"job", pooling.job.empty() ? Json(nullptr) : Json(std::string(kJobs) + pooling.job)},
              {"reason", pooling.reason.empty() ? Json(nullptr) : Json(pooling.reason)}};
}

/// One line for people; empty where all is put together.
std::string note_of(const AxisPooling& pooling) {
  if (pooling.state == PoolingState::Pending) {
    return "pooling pending: replicates are averaged until " + std::string(kJobs) + pooling.job +
           " has fitted them jointly.\n";
  }
  if (pooling.state == PoolingState::Failed) {
    return "pooling failed: replicates are averaged, for " + std::string(kJobs) + pooling.job +
           " could not fit them jointly. " + pooling.reason + "\n";
  }
  return "";
}

/// Marks an answer that changes when the job which pools has ended: a CSV has no place of its own for that.
void say_pending(const AxisPooling& pooling, Response& response) {
  if (pooling.state == PoolingState::Pending && response.pending_job.empty()) {
    response.pending_job = pooling.job;
    response.headers.emplace_back("Retry-After", "1");
    response.headers.emplace_back("Link", "<" + std::string(kJobs) + pooling.job + ">; rel=\"monitor\"");
  }
}

/// The document with what is said about its pooling.
Response pooled_response(Json document, const AxisPooling& pooling) {
  document["pooling"] = to_json(pooling);
  Response response = json_response(200, document);
  say_pending(pooling, response);
  response.headers.emplace_back("Vary", "Accept");
  return response;
}

Result<StoredTableRequest> table_request(const Request& request) {
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
  wanted.reference = request.parameter("reference").value_or("");
  return wanted;
}

/// One table as text of that media type.
std::string text_of(const StoredTable& stored, std::string_view type) {
  const std::string note = note_of(stored.pooling);
  if (type == "text/csv") {
    return table_to_csv(stored.table);
  }
  if (type == "text/x-latex") {
    return table_to_latex(stored.table) + (note.empty() ? "" : "% " + note);
  }
  return type == "text/markdown" ? table_to_markdown(stored.table) + (note.empty() ? "" : "\n" + note)
                                 : table_to_text(stored.table) + (note.empty() ? "" : "! " + note);
}

/// One table as it is, those of all axes in one document.
Result<Response> table_as_json(Store& store, const StoredTableRequest& wanted) {
  if (wanted.axis != "all") {
    return table_document(store, wanted).map([](TableDocument table) {
      return pooled_response(std::move(table.document), table.pooling);
    });
  }
  auto tables = table_documents(store, wanted);
  if (!tables) {
    return fail(tables.error());
  }
  const Json& first = tables->front().document;
  Json document{
      {"device", first["device"]}, {"sensor", first["sensor"]}, {"method", first["method"]}, {"tables", Json::array()}};
  for (TableDocument& table : *tables) {
    table.document["pooling"] = to_json(table.pooling);
    document["tables"].push_back(std::move(table.document));
  }
  Response response = json_response(200, document);
  for (const TableDocument& table : *tables) {
    say_pending(table.pooling, response);
  }
  response.headers.emplace_back("Vary", "Accept");
  return response;
}

/// Texts of all axes have an empty line between them.
Result<Response> table_as_text(Store& store, const StoredTableRequest& wanted, std::string_view type) {
  const auto tables =
      wanted.axis == "all" ? stored_tables(store, wanted) : stored_table(store, wanted).map([](StoredTable table) {
        return std::vector<StoredTable>{std::move(table)};
      });
  if (!tables) {
    return fail(tables.error());
  }
  Response response;
  response.content_type = std::string(type) + "; charset=utf-8";
  for (const StoredTable& stored : *tables) {
    response.body += (response.body.empty() ? "" : "\n") + text_of(stored, type);
    say_pending(stored.pooling, response);
  }
  response.headers.emplace_back("Vary", "Accept");
  return response;
}

Result<Response> get_table(ApiContext& context, const Request& request) {
  const auto type = negotiate(request.header("accept"),
                              {"application/json", "text/csv", "text/plain", "text/markdown", "text/x-latex"});
  if (!type) {
    return problem_response(HttpFault::NotAcceptable,
                            "Offered are application/json, text/csv, text/plain, text/markdown and text/x-latex.");
  }
  const auto wanted = table_request(request);
  if (!wanted) {
    return fail(wanted.error());
  }
  return *type == "application/json" ? table_as_json(context.store, *wanted)
                                     : table_as_text(context.store, *wanted, *type);
}

Result<Response> get_trends(ApiContext& context, const Request& request) {
  const auto type =
      negotiate(request.header("accept"), {"application/json", "text/csv", "text/plain", "text/markdown"});
  if (!type) {
    return problem_response(HttpFault::NotAcceptable,
                            "Offered are application/json, text/csv, text/plain and text/markdown.");
  }
  const auto wanted = table_request(request);
  if (!wanted) {
    return fail(wanted.error());
  }
  if (*type == "application/json") {
    return trends_document(context.store, *wanted).map([](TableDocument trends) {
      return pooled_response(std::move(trends.document), trends.pooling);
    });
  }
  const auto stored = stored_table(context.store, *wanted);
  if (!stored) {
    return fail(stored.error());
  }
  const TrendTable trends = build_trends(stored->table);
  const std::string note = note_of(stored->pooling);
  Response response;
  say_pending(stored->pooling, response);
  response.headers.emplace_back("Vary", "Accept");
  if (*type == "text/plain") {
    response.content_type = "text/plain; charset=utf-8";
    response.body = trends_to_text(trends) + (note.empty() ? "" : "! " + note);
  } else if (*type == "text/csv") {
    response.content_type = "text/csv; charset=utf-8";
    response.body = trends_to_csv(trends);
  } else if (*type == "text/markdown") {
    response.content_type = "text/markdown; charset=utf-8";
    response.body = trends_to_markdown(trends) + (note.empty() ? "" : "\n" + note);
  }
  return response;
}

}  // namespace

void add_parameter_table_routes(Router& router, ApiContext& context) {
  router.add(from_rows({"GET",
                        "/v1/parameter-tables",
                        "getParameterTable",
                        {"device", "sensor", "axis", "method", "model", "reference"},
                        Handler([&](const Request& request) { return get_table(context, request); })}));
  router.add(from_rows({"GET",
                        "/v1/trends",
                        "getTrends",
                        {"device", "sensor", "axis", "method", "model"},
                        Handler([&](const Request& request) { return get_trends(context, request); })}));
}

}  // namespace driftlab::server
