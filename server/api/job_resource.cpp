#include "server/api/job_resource.hpp"

#include <algorithm>

namespace driftlab::server {
namespace {

/// Without the result, as in lists.
Json object_summary(const Job& job, const JobResource& resource) {
  const Json whole = to_json(job);
  Json document{{"id", job.id}, {"job", Json{{"href", "/v1/jobs/" + job.id}}}};
  document.update(resource.about(job.is_damaged ? Json(nullptr) : whole["request"]));
  for (const char* const name : {"state", "stage", "progress", "created_at", "finished_at", "problem"}) {
    document[name] = whole[name];
  }
  return document;
}

Result<Json> whole_object(ApiContext& context, const Job& job, const JobResource& resource) {
  Json document = object_summary(job, resource);
  document["evaluation"] = nullptr;
  if (resource.partial != nullptr && job.state == JobState::Running) {
    document["partial"] = resource.partial(job.stage);
  }
  if (job.state == JobState::Succeeded) {
    auto result = context.store.result_document(job.id);
    if (!result) {
      return fail(result.error());
    }
    document["evaluation"] = stored(*result);
  }
  return document;
}

/// Faults that the job kind found, at their places in the resource's body.
Error located_in_body(Error error) {
  for (ErrorField& field : error.fields) {
    for (const std::string_view prefix : {"/inputs", "/parameters"}) {
      if (field.name.starts_with(prefix)) {
        field.name.erase(0, prefix.size());
        field.name = field.name.empty() ? "/" : field.name;  // the document as a whole
        break;
      }
    }
  }
  return error;
}

/// The members of a body by where they go in a job's request.
struct SortedBody {
  Json inputs = Json::object();
  Json parameters = Json::object();
  int priority = 5;
};

Result<SortedBody> sorted_body(const Request& request, const JobResource& resource) {
  const auto body = parse_json(request.body);
  if (!body) {
    return fail(body.error());
  }
  Faults faults;
  SortedBody sorted;
  ObjectReader reader(*body, "", faults);
  const auto take = [&](const std::vector<const char*>& names, Json& into) {
    for (const char* const name : names) {
      if (const Json* const value = reader.member(name)) {
        into[name] = *value;
      }
    }
  };
  take(resource.inputs, sorted.inputs);
  take(resource.parameters, sorted.parameters);
  sorted.priority = static_cast<int>(std::clamp<std::int64_t>(reader.integer("priority").value_or(5), -1, 10));
  reader.reject_unknown();
  if (sorted.priority < 0 || sorted.priority > 9) {
    faults.add("/priority", ErrorCode::InvalidArgument, "The priority is a whole number from 0 (first) to 9.");
  }
  return faults.none() ? Result<SortedBody>(std::move(sorted)) : fail(faults.error());
}

void say_pending(const Job& job, Response& response) {
  if (!is_terminal(job.state)) {
    response.pending_job = job.id;
    response.headers.emplace_back("Retry-After", "1");
  }
}

}  // namespace

Result<Response> create_job_object(ApiContext& context, const Request& request, const JobResource& resource) {
  const auto body = sorted_body(request, resource);
  if (!body) {
    return fail(body.error());
  }
  if (auto full = refuse_full_queue(context.store, context.budgets)) {
    return std::move(*full);
  }
  JobContext job_context = context.job_context();
  auto job = new_job(*find_job_kind(resource.kind), body->inputs, body->parameters, job_context);
  if (!job) {
    return refused_job(located_in_body(job.error()));
  }
  job->priority = body->priority;
  auto queued = context.store.enqueue(*job);
  if (!queued) {
    return fail(queued.error());
  }
  if (queued->created) {
    announce_job(context, queued->job.id);
    context.wake_workers();
  }
  auto document = whole_object(context, queued->job, resource);
  if (!document) {
    return fail(document.error());
  }
  Response response = json_response(queued->created ? 202 : 200, *document);
  say_pending(queued->job, response);
  response.headers.emplace_back("Location", std::string(resource.path) + "/" + queued->job.id);
  return response;
}

Result<Response> list_job_objects(ApiContext& context, const Request& request, const JobResource& resource) {
  JobFilter filter;
  filter.kind = std::string(resource.kind);
  auto state = state_filter(request);
  if (!state) {
    return fail(state.error());
  }
  filter.state = *state;
  auto sought = text_filter(request);
  auto since = since_filter(request);
  if (!sought || !since) {
    return fail(sought ? since.error() : sought.error());
  }
  filter.scenario = std::move(*sought);
  filter.since = *since;
  return list_rows(
      request, [&](const Page& page) { return context.store.jobs(filter, page); },
      [&](const Job& job) { return object_summary(job, resource); });
}

Result<Response> get_job_object(ApiContext& context, const Request& request, const JobResource& resource) {
  auto job = context.store.job(request.parameters[0]);
  if (!job) {
    return fail(job.error());
  }
  if (job->kind != resource.kind) {
    return fail(ErrorCode::NotFound, "The job " + job->id + " is no " + std::string(resource.noun) + ".");
  }
  auto document = whole_object(context, *job, resource);
  if (!document) {
    return fail(document.error());
  }
  Response response = json_response(200, *document);
  say_pending(*job, response);
  return response;
}

}  // namespace driftlab::server
