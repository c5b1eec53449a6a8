/// Outage evaluations: jobs of kind `outage_evaluation` under a name of their own, with their results.
#include "schema/json/json.hpp"
#include "server/api/api.hpp"
#include "server/api/documents.hpp"

#include <algorithm>

namespace driftlab::server {
namespace {

constexpr std::string_view kKind = "outage_evaluation";

std::string address_of(const Job& job) { return "/v1/outage-evaluations/" + job.id; }

/// Without the result, as in lists.
Json summary(const Job& job) {
  const Json whole = to_json(job);
  const Json& request = whole["request"];
  Json document{{"id", job.id}, {"job", Json{{"href", "/v1/jobs/" + job.id}}}};
  Json scenario = request.is_object() ? request["inputs"]["scenario"] : Json(nullptr);
  const bool named = scenario.is_string();
  document["scenario_name"] =
      named ? scenario : (scenario.is_object() && scenario.contains("name") ? scenario["name"] : Json(""));
  for (const char* const name : {"runs", "seed", "relative_precision"}) {
    document[name] = request.is_object() ? request["parameters"][name] : Json(nullptr);
  }
  for (const char* const name : {"state", "stage", "progress", "created_at", "finished_at", "problem"}) {
    document[name] = whole[name];
  }
  return document;
}

Result<Json> complete(ApiContext& context, const Job& job) {
  Json document = summary(job);
  document["evaluation"] = nullptr;
  if (job.state == JobState::Succeeded) {
    auto result = context.store.result_document(job.id);
    if (!result) {
      return fail(result.error());
    }
    document["evaluation"] = stored(*result);
  }
  return document;
}

/// Faults that the job kind found, at their places in this resource's body.
Error located_in_body(Error error) {
  for (ErrorField& field : error.fields) {
    for (const std::string_view prefix : {"/inputs", "/parameters"}) {
      if (field.name.starts_with(prefix)) {
        field.name.erase(0, prefix.size());
        break;
      }
    }
  }
  return error;
}

Result<Response> create(ApiContext& context, const Request& request) {
  auto body = parse_json(request.body);
  if (!body) {
    return fail(body.error());
  }
  Faults faults;
  ObjectReader reader(*body, "", faults);
  Json inputs = Json::object();
  if (const Json* const scenario = reader.member("scenario")) {
    inputs["scenario"] = *scenario;
  }
  Json parameters = Json::object();
  for (const char* const name : {"runs", "seed", "relative_precision"}) {
    if (const Json* const value = reader.member(name)) {
      parameters[name] = *value;
    }
  }
  const int priority = static_cast<int>(std::clamp<std::int64_t>(reader.integer("priority").value_or(5), -1, 10));
  reader.reject_unknown();
  if (priority < 0 || priority > 9) {
    faults.add("/priority", ErrorCode::InvalidArgument, "The priority is a whole number from 0 (first) to 9.");
  }
  if (!faults.none()) {
    return fail(faults.error());
  }
  if (auto full = refuse_full_queue(context.store, context.budgets)) {
    return std::move(*full);
  }
  JobContext job_context{context.store, context.blobs, context.clock, context.budgets};
  auto job = new_job(*find_job_kind(kKind), inputs, parameters, job_context);
  if (!job) {
    return refused_job(located_in_body(job.error()));
  }
  job->priority = priority;
  auto queued = context.store.enqueue(*job);
  if (!queued) {
    return fail(queued.error());
  }
  if (queued->created) {
    announce_job(context, queued->job.id);
    context.wake_workers();
  }
  auto document = complete(context, queued->job);
  if (!document) {
    return fail(document.error());
  }
  Response response = json_response(queued->created ? 202 : 200, *document);
  if (!is_terminal(queued->job.state)) {
    response.pending_job = queued->job.id;
    response.headers.emplace_back("Retry-After", "1");
  }
  response.headers.emplace_back("Location", address_of(queued->job));
  return response;
}

Result<Response> list(ApiContext& context, const Request& request) {
  JobFilter filter;
  filter.kind = std::string(kKind);
  auto state = state_filter(request);
  if (!state) {
    return fail(state.error());
  }
  filter.state = *state;
  return list_rows(
      request, [&](const Page& page) { return context.store.jobs(filter, page); },
      [](const Job& job) { return summary(job); });
}

Result<Response> get(ApiContext& context, const Request& request) {
  auto job = context.store.job(request.parameters[0]);
  if (!job) {
    return fail(job.error());
  }
  if (job->kind != kKind) {
    return fail(ErrorCode::NotFound, "The job " + job->id + " is no outage evaluation.");
  }
  auto document = complete(context, *job);
  if (!document) {
    return fail(document.error());
  }
  Response response = json_response(200, *document);
  if (!is_terminal(job->state)) {
    response.pending_job = job->id;
    response.headers.emplace_back("Retry-After", "1");
  }
  return response;
}

}  // namespace

void add_outage_evaluation_routes(Router& router, ApiContext& context) {
  router.add({"GET",
              "/v1/outage-evaluations",
              "listOutageEvaluations",
              {"limit", "cursor", "sort", "state"},
              Handler([&](const Request& request) { return list(context, request); })});
  router.add({"POST", "/v1/outage-evaluations", "createOutageEvaluation", {}, Handler([&](const Request& request) {
                return create(context, request);
              })});
  router.add({"GET", "/v1/outage-evaluations/{id}", "getOutageEvaluation", {}, Handler([&](const Request& request) {
                return get(context, request);
              })});
}

}  // namespace driftlab::server
