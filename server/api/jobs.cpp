#include "schema/json/json.hpp"
#include "schema/json/partial_outages.hpp"
#include "server/api/api.hpp"
#include "server/api/documents.hpp"

#include <charconv>

namespace driftlab::server {
namespace {

Response job_response(int status, const Job& job) {
  Response response = json_response(status, to_json(job));
  if (!is_terminal(job.state)) {
    response.pending_job = job.id;
    response.headers.emplace_back("Retry-After", "1");
  }
  return response;
}

Result<Response> create_job(ApiContext& context, const Request& request) {
  auto body = parse_json(request.body);
  if (!body) {
    return fail(body.error());
  }
  Faults faults;
  ObjectReader reader(*body, "", faults);
  const std::string name = reader.required_text("kind");
  const Json* const inputs = reader.member("inputs");
  const Json* const parameters = reader.member("parameters");
  const int priority = static_cast<int>(std::clamp<std::int64_t>(reader.integer("priority").value_or(5), -1, 10));
  reader.reject_unknown();
  if (priority < 0 || priority > 9) {
    faults.add("/priority", ErrorCode::InvalidArgument, "The priority is a whole number from 0 (first) to 9.");
  }
  const JobKind* const kind = find_job_kind(name);
  if (kind == nullptr && (!name.empty() || faults.none())) {
    std::string known;
    for (const auto& each : job_kinds()) {
      known += (known.empty() ? "" : ", ") + std::string(each->name());
    }
    faults.add("/kind", ErrorCode::InvalidArgument,
               "The job kind '" + name + "' is not known; known are " + known + ".");
  }
  if (kind == nullptr || !faults.none()) {
    return fail(faults.error());
  }
  if (auto full = refuse_full_queue(context.store, context.budgets)) {
    return std::move(*full);
  }
  JobContext job_context = context.job_context();
  auto job = new_job(*kind, inputs != nullptr ? *inputs : Json::object(),
                     parameters != nullptr ? *parameters : Json::object(), job_context);
  if (!job) {
    return refused_job(job.error());
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
  // The same job again: 200 with the one that exists (service-conventions section 2, natural keys).
  Response response = job_response(queued->created ? 202 : 200, queued->job);
  response.headers.emplace_back("Location", "/v1/jobs/" + queued->job.id);
  return response;
}

Result<Response> list_jobs(ApiContext& context, const Request& request) {
  JobFilter filter;
  if (const auto kind = request.parameter("kind")) {
    filter.kind = *kind;
  }
  auto state = state_filter(request);
  if (!state) {
    return fail(state.error());
  }
  filter.state = *state;
  auto device_id = device_filter(context.store, request);
  if (!device_id) {
    return fail(device_id.error());
  }
  filter.device_id = std::move(*device_id);
  return list_rows(
      request, [&](const Page& page) { return context.store.jobs(filter, page); },
      [](const Job& job) { return to_json(job); });
}

Result<Response> get_job(ApiContext& context, const Request& request) {
  auto job = context.store.job(request.parameters[0]);
  if (!job) {
    return fail(job.error());
  }
  return job_response(200, *job);
}

Result<Response> get_result(ApiContext& context, const Request& request) {
  auto job = context.store.job(request.parameters[0]);
  if (!job) {
    return fail(job.error());
  }
  if (job->state != JobState::Succeeded) {
    return fail(ErrorCode::NotFound,
                "The job " + job->id + " has no result; it is " + std::string(name_of(job->state)) + ".",
                {{"state", std::string(name_of(job->state))}});
  }
  auto document = context.store.result_document(job->id);
  if (!document) {
    return fail(document.error());
  }
  Response response;
  response.body = std::move(*document);
  return response;
}

Result<Response> cancel_job(ApiContext& context, const Request& request) {
  auto job = context.store.request_cancel(request.parameters[0]);
  if (!job) {
    return fail(job.error());
  }
  context.wake_workers();
  context.bell.ring(job->id);
  announce_job(context, job->id);
  return job_response(202, *job);
}

class JobEvents final : public EventSource {
 public:
  JobEvents(Store& store, std::string job_id, std::int64_t after)
      : store_(store), job_id_(std::move(job_id)), after_(after) {}

  [[nodiscard]] const std::string& subject() const override { return job_id_; }

  [[nodiscard]] Result<Batch> next() override {
    constexpr int kMost = 200;
    auto events = store_.events_after(job_id_, after_, kMost);
    if (!events) {
      return fail(events.error());
    }
    Batch batch;
    for (const JobEvent& event : *events) {
      after_ = event.sequence;
      Json data{{"job", job_id_},
                {"state", name_of(event.state)},
                {"stage", event.stage.empty() ? Json(nullptr) : Json(event.stage)},
                {"progress", number(event.progress)},
                {"attempt", event.attempt},
                {"at", rfc3339(event.at)}};
      if (Json partial = partial_outages_json(event.stage); !partial.is_null()) {
        data["partial"] = std::move(partial);
      }
      batch.text +=
          "id: " + std::to_string(event.sequence) + "\nevent: " + event.type + "\ndata: " + to_text(data) + "\n\n";
      batch.last = event.type == "state" && is_terminal(event.state);
    }
    if (events->empty()) {
      // A client that resumes after the terminal event gets nothing more: close at once.
      auto job = store_.job(job_id_);
      batch.last = job && is_terminal(job->state);
    }
    return batch;
  }

 private:
  Store& store_;
  std::string job_id_;
  std::int64_t after_;
};

Result<std::unique_ptr<EventSource>> job_events(ApiContext& context, const Request& request) {
  auto job = context.store.job(request.parameters[0]);
  if (!job) {
    return fail(job.error());
  }
  std::int64_t after = 0;
  if (const auto last = request.header("last-event-id")) {
    const auto [stop, error] = std::from_chars(last->data(), last->data() + last->size(), after);
    if (error != std::errc{} || stop != last->data() + last->size()) {
      return fail(ErrorCode::InvalidArgument, "Last-Event-ID must be the id of an event of this stream.",
                  {{"parameter", "Last-Event-ID"}});
    }
  }
  return std::make_unique<JobEvents>(context.store, job->id, after);
}

}  // namespace

void add_job_routes(Router& router, ApiContext& context) {
  router.add({"GET",
              "/v1/jobs",
              "listJobs",
              {"limit", "cursor", "sort", "kind", "state", "device"},
              Handler([&](const Request& request) { return list_jobs(context, request); })});
  router.add({"POST", "/v1/jobs", "createJob", {}, Handler([&](const Request& request) {
                return create_job(context, request);
              })});
  router.add({"GET", "/v1/jobs/{id}", "getJob", {}, Handler([&](const Request& request) {
                return get_job(context, request);
              })});
  router.add({"GET", "/v1/jobs/{id}/result", "getJobResult", {}, Handler([&](const Request& request) {
                return get_result(context, request);
              })});
  router.add({"POST", "/v1/jobs/{id}/cancel", "cancelJob", {}, Handler([&](const Request& request) {
                return cancel_job(context, request);
              })});
  router.add({"GET", "/v1/jobs/{id}/events", "streamJobEvents", {}, EventHandler([&](const Request& request) {
                return job_events(context, request);
              })});
}

}  // namespace driftlab::server
