#include "schema/contract.hpp"
#include "server/api/api.hpp"
#include "server/api/documents.hpp"
#include "server/http/problem.hpp"
#include "server/store/told_error.hpp"

namespace driftlab::server {
namespace {

Response text_response(std::string_view type, std::string_view text) {
  Response response;
  response.content_type = type;
  response.body = text;
  return response;
}

constexpr std::size_t kMostStates = 100;  // damaged files may be many; damaged_files counts them

Result<Response> ready(const ApiContext& context) {
  if (const std::string why = context.not_ready_why(); !why.empty()) {
    return problem_response(HttpFault::NotReady, why);
  }
  Json document{{"status", "ready"}};
  if (const std::size_t damaged = context.damaged_blobs ? context.damaged_blobs() : 0; damaged > 0) {
    document["damaged_files"] = damaged;
  }
  if (const std::string newer = context.newer_schema ? context.newer_schema() : std::string(); !newer.empty()) {
    document["newer_schema"] = newer;
  }
  for (const StandingState& standing : context.bad_states ? context.bad_states() : std::vector<StandingState>{}) {
    Json state{{"state", name_of(standing.state)},
               {"cause", standing.cause},
               {"since", rfc3339(standing.since)},
               {"detail", without_paths({ErrorCode::Io, standing.detail, {}}).message}};
    if (!standing.object.empty()) {
      state[standing.state == BadState::RowDamaged ? "row" : "file"] = standing.object;
    }
    document["states"].push_back(std::move(state));
    if (document["states"].size() == kMostStates) {
      break;
    }
  }
  return json_response(200, document);
}

/// The page a person sees at `/` until the dashboard is there: where to go from here.
std::string front_page() {
  return "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>driftlab</title></head>\n<body>\n"
         "<h1>driftlab " DRIFTLAB_VERSION
         "</h1>\n"
         "<p>This daemon characterises the stochastic errors of inertial sensors.</p>\n<ul>\n"
         "<li><a href=\"/v1/devices\">Devices</a>, <a href=\"/v1/recordings\">recordings</a>, "
         "<a href=\"/v1/jobs\">jobs</a>, <a href=\"/v1/fits\">fits</a></li>\n"
         "<li>Parameter tables: "
         "<code>/v1/parameter-tables?device=NAME&amp;sensor=gyroscope&amp;axis=z&amp;method=gmwm</code></li>\n"
         "<li><a href=\"/openapi.json\">The API contract</a> and <a href=\"/docs\">the documentation</a></li>\n"
         "</ul>\n</body></html>\n";
}

Result<Response> list_docs() {
  Json pages = Json::array();
  for (const ContractFile& file : contract_files()) {
    if (file.name.starts_with("docs/") && file.name.ends_with(".md")) {
      const std::string_view name = file.name.substr(5, file.name.size() - 8);
      pages.push_back(Json{{"name", name}, {"href", "/docs/" + std::string(name)}});
    }
  }
  Json problems = Json::array();
  for (const ProblemType& type : problem_types()) {
    problems.push_back(Json{{"slug", type.slug}, {"href", "/problems/" + std::string(type.slug)}});
  }
  return json_response(200, Json{{"pages", std::move(pages)}, {"problems", std::move(problems)}});
}

Result<Response> get_doc(const Request& request) {
  // Pages link to each other as files do, `recordings.md`; here they have no suffix.
  std::string_view page = request.parameters[0];
  if (page.ends_with(".md")) {
    page.remove_suffix(3);
  }
  const std::string_view text = contract_file("docs/" + std::string(page) + ".md");
  if (text.empty()) {
    return fail(ErrorCode::NotFound,
                "There is no documentation page '" + request.parameters[0] + "'; /docs lists them.");
  }
  return text_response("text/markdown; charset=utf-8", text);
}

Result<Response> get_problem_page(const Request& request) {
  const ProblemType* const type = find_problem_type(request.parameters[0]);
  if (type == nullptr) {
    return fail(ErrorCode::NotFound, "There is no problem type '" + request.parameters[0] + "'; /docs lists them.");
  }
  return text_response(
      "text/markdown; charset=utf-8",
      "# " + std::string(type->title) + "\n\nStatus " + std::to_string(type->status) + ". " +
          (type->retryable ? "Trying again may help.\n\n" : "Trying again as it is will not help.\n\n") +
          std::string(type->explanation) + "\n");
}

Result<Response> get_schema(const Request& request) {
  const std::string& name = request.parameters[0];
  const bool is_schema = name.ends_with(".schema.json");
  const std::string_view text = is_schema || name == "number-format.json" ? contract_file(name) : std::string_view();
  if (text.empty()) {
    return fail(ErrorCode::NotFound, "There is no schema '" + name + "'.");
  }
  return text_response(is_schema ? "application/schema+json" : "application/json", text);
}

}  // namespace

void add_watch_routes(Router& router, ApiContext& context) {
  Response alive = json_response(200, Json{{"status", "alive"}, {"version", context.version}});
  alive.headers.emplace_back("ETag", content_etag(alive));
  Route health{"GET", "/healthz", "health", {}, Handler([alive = std::move(alive)](const Request&) -> Result<Response> {
                 return alive;
               })};
  health.lane = Lane::Instant;
  router.add(std::move(health));
  router.add({"GET", "/readyz", "readiness", {}, Handler([&](const Request&) { return ready(context); })});
  router.add({"GET", "/metrics", "metrics", {}, Handler([&](const Request&) -> Result<Response> {
                Response response = text_response("text/plain; version=0.0.4; charset=utf-8",
                                                  context.metrics ? context.metrics() : std::string());
                response.volatile_body = true;
                return response;
              })});
}

void add_service_routes(Router& router, ApiContext& context) {
  router.add({"GET", "/", "frontPage", {}, Handler([](const Request&) -> Result<Response> {
                return text_response("text/html; charset=utf-8", front_page());
              })});
  add_watch_routes(router, context);
  router.add({"GET", "/openapi.json", "contract", {}, Handler([](const Request&) -> Result<Response> {
                return text_response("application/json", contract_file("openapi.json"));
              })});
  router.add({"GET", "/docs", "listDocumentation", {}, Handler([](const Request&) { return list_docs(); })});
  router.add({"GET", "/docs/{page}", "getDocumentation", {}, Handler([](const Request& r) { return get_doc(r); })});
  router.add(
      {"GET", "/problems/{slug}", "getProblemType", {}, Handler([](const Request& r) { return get_problem_page(r); })});
  router.add({"GET", "/schemas/{name}", "getSchema", {}, Handler([](const Request& r) { return get_schema(r); })});
}

}  // namespace driftlab::server
