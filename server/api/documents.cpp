#include "server/api/documents.hpp"

#include "core/signal/condition.hpp"
#include "schema/json/recording_spec.hpp"
#include "server/http/compression.hpp"
#include "server/http/problem.hpp"
#include "server/jobs/stored_table.hpp"
#include "server/store/damaged_row.hpp"
#include "server/store/digest.hpp"

#include <algorithm>
#include <array>

namespace driftlab::server {
namespace {

constexpr char kBeside = '~';  ///< in an ETag: what follows is no state of the object

/// Where the results of a kind of job are read.
struct ResultPlace {
  std::string_view kind;
  std::string_view folder;        ///< of a resource of its own; empty: `/v1/jobs/{id}/result`
  bool by_investigation = false;  ///< the objects of that resource have ids of investigations, not of jobs
};

/// One line per kind of server/jobs/job_kinds.cpp; tests/house/documents.py compares them.
constexpr auto kResultPlaces = std::to_array<ResultPlace>({
    {"characterise", ""},
    {"pool", ""},
    {"outage_evaluation", "/v1/outage-evaluations/"},
    {"drive_evaluation", "/v1/drive-evaluations/"},
    {"investigate", "/v1/investigations/", true},
    {"regress", "/v1/regressions/"},
});

Json time_or_null(const std::optional<UtcMicros>& time) { return time ? Json(rfc3339(*time)) : Json(nullptr); }

/// Of a damaged job nothing that it asked for is shown.
Json request_of(const Job& job) {
  return job.is_damaged ? Json{{"kind", job.kind},
                               {"inputs", Json::object()},
                               {"parameters", Json::object()},
                               {"algorithm_version", 1}}
                        : stored(job.request_json);
}

/// Nor how it ended, but that this is not known any more.
Json problem_of(const Job& job) {
  if (job.is_damaged) {
    return stored(problem_document(damaged_row("jobs", "job", job.id)));
  }
  return job.problem_json.empty() ? Json(nullptr) : stored(job.problem_json);
}

/// Whether an answer is what a GET of the member that was made gives too. What may be stored nowhere is read nowhere.
bool is_readable_again(const Request& request, const Response& response) {
  return !response.has_header("Cache-Control") && std::ranges::any_of(response.headers, [&](const auto& header) {
    return header.first == "Location" && header.second.starts_with(request.path + "/");
  });
}

}  // namespace

Json stored(const std::string& text) {
  auto document = parse_json(text);
  return document ? std::move(*document) : Json(nullptr);
}

Json to_json(const Device& device) {
  return Json{{"id", device.id},
              {"name", device.name},
              {"model", device.model},
              {"imu", device.imu},
              {"serial", device.serial},
              {"labels", stored(device.labels_json)},
              {"revision", device.revision},
              {"created_at", rfc3339(device.created_at)},
              {"updated_at", rfc3339(device.updated_at)}};
}

Json to_json(const Job& job) {
  Json document{{"id", job.id},
                {"kind", job.kind},
                {"state", name_of(job.state)},
                {"stage", job.stage.empty() ? Json(nullptr) : Json(job.stage)},
                {"progress", number(job.progress)},
                {"attempt", job.attempt},
                {"priority", job.priority},
                {"cancel_requested", job.cancel_requested},
                {"created_at", rfc3339(job.created_at)},
                {"started_at", time_or_null(job.started_at)},
                {"finished_at", time_or_null(job.finished_at)},
                {"device_name", job.device_name.empty() ? Json(nullptr) : Json(job.device_name)},
                {"recording_name", job.recording_name.empty() ? Json(nullptr) : Json(job.recording_name)},
                {"request", request_of(job)}};
  document["result"] =
      job.state == JobState::Succeeded ? Json{{"href", "/v1/jobs/" + job.id + "/result"}} : Json(nullptr);
  document["problem"] = problem_of(job);
  Json attempts = Json::array();
  for (const std::string& problem : job.attempt_problems_json) {
    attempts.push_back(stored(problem));
  }
  document["failed_attempts"] = std::move(attempts);
  return document;
}

Json to_json(const Fit& fit) {
  Json document{{"id", fit.id},
                {"device", fit.device_id},
                {"recording", fit.recording_id},
                {"recording_revision", fit.recording_revision},
                {"job", fit.job_id},
                {"channel", fit.channel},
                {"quantity", fit.quantity},
                {"axis", fit.axis.empty() ? Json(nullptr) : Json(fit.axis)}};
  const auto condition = parse_condition(fit.condition);
  document["condition"] = condition ? driftlab::to_json(*condition) : Json(nullptr);
  document["rank"] = fit.rank;
  const Json body = stored(fit.document_json);
  for (const auto& [name, value] : body.items()) {
    document[name] = value;
  }
  document["created_at"] = rfc3339(fit.created_at);
  return document;
}

std::string result_address(std::string_view kind, const std::string& job, const std::string& investigation) {
  const auto* const place = std::ranges::find(kResultPlaces, kind, &ResultPlace::kind);
  if (place == kResultPlaces.end() || place->folder.empty() || (place->by_investigation && investigation.empty())) {
    return "/v1/jobs/" + job + "/result";
  }
  return std::string(place->folder) + (place->by_investigation ? investigation : job);
}

std::string own_key(const Request& request, std::string_view key) {
  const std::string& token = request.caller.principal.token;
  return token.empty() ? std::string(key) : token + ':' + std::string(key);
}

Error malformed_idempotency_key() {
  return {ErrorCode::InvalidArgument,
          "An Idempotency-Key is 1 to 64 of the characters A-Z a-z 0-9 . _ -",
          {{"parameter", "Idempotency-Key"}}};
}

Response replay(const IdempotentReply& reply, const Request& request, const std::string& body_sha256) {
  if (reply.method != request.method || reply.target != request.target || reply.body_sha256 != body_sha256) {
    return problem_response(HttpFault::IdempotencyKeyReused, "The Idempotency-Key belongs to another request.");
  }
  Response response;
  response.status = reply.status;
  response.body = reply.body;
  const Json headers = stored(reply.headers_json);
  for (const auto& [name, value] : headers.items()) {
    response.headers.emplace_back(name, value.get<std::string>());
  }
  response.headers.emplace_back("Idempotency-Replayed", "true");
  return response;
}

IdempotentReply reply_to_remember(const std::string& key, const Request& request, const std::string& body_sha256,
                                  const Response& response, UtcMicros now) {
  Json headers = Json::object();
  for (const auto& [name, value] : response.headers) {
    headers[name] = value;
  }
  const bool kept = response.body.size() <= static_cast<std::size_t>(request.budgets->reply_bytes) ||
                    !is_readable_again(request, response);
  return {key,
          request.method,
          request.target,
          body_sha256,
          response.status,
          to_text(headers),
          kept ? response.body : std::string(),
          now};
}

Result<Response> refused_job(const Error& error) {
  const auto pool = std::find_if(error.fields.begin(), error.fields.end(),
                                 [](const ErrorField& field) { return field.name == kPendingPool; });
  if (pool == error.fields.end()) {
    return fail(error);
  }
  Response response = problem_response(HttpFault::PoolingPending, error.message);
  response.headers.emplace_back("Retry-After", "1");
  response.pending_job = pool->value;
  response.undone = true;
  return response;
}

std::optional<Response> refuse_full_queue(Store& store, const Budgets& budgets) {
  // The queue is everybody's: also those wait in it that the caller may not see.
  const Caller whole;
  const ActingFor nobody(whole);
  const auto counts = store.counts();
  if (!counts || counts->queued < budgets.queued_jobs) {
    return std::nullopt;
  }
  return problem_response(HttpFault::Busy,
                          "Too many jobs wait " + naming_budget("queued_jobs", budgets.queued_jobs) + ".");
}

Response json_response(int status, const Json& document) {
  Response response;
  response.status = status;
  response.body = to_text(document) + "\n";  // a prompt begins on a line of its own
  return response;
}

std::string etag_of(std::string_view id, std::int64_t revision) {
  return "\"" + std::string(id) + "-r" + std::to_string(revision) + "\"";
}

std::string content_etag(const Response& response) {
  return '"' + sha256_hex(response.body + response.content_type).substr(0, 32) + '"';
}

std::optional<Response> refuse_other_content(const Request& request, const Response& response) {
  const auto match = request.header("if-match");
  if (!match || *match == "*" || plain_tag(*match) == content_etag(response)) {
    return std::nullopt;
  }
  return problem_response(HttpFault::PreconditionFailed,
                          "The object is not what If-Match names; its ETag is " + content_etag(response) + ".");
}

std::string etag_of(const Recording& recording) {
  std::string etag = etag_of(recording.id, recording.revision);
  if (recording.tags_revision > 0) {
    etag.insert(etag.size() - 1, "." + std::to_string(recording.tags_revision));
  }
  return etag;
}

std::string shown_etag(const std::string& etag, const std::string& beside) {
  return beside.empty() ? etag : etag.substr(0, etag.size() - 1) + kBeside + beside + '"';
}

std::optional<Response> refuse_stale(const Request& request, const std::string& etag) {
  const auto match = request.header("if-match");
  if (!match) {
    return problem_response(
        HttpFault::PreconditionRequired,
        "Send If-Match with the ETag of the object as you read it: " + etag + " is the current one.");
  }
  std::string state(plain_tag(*match));
  if (const std::size_t beside = state.find(kBeside); beside != std::string::npos) {
    state.replace(beside, std::string::npos, "\"");
  }
  if (*match == "*" || state == etag) {
    return std::nullopt;
  }
  return problem_response(HttpFault::PreconditionFailed, "The object has changed; its ETag is now " + etag + ".");
}

tl::expected<std::int64_t, Response> expected_revision(const Request& request, std::string_view id,
                                                       std::int64_t current) {
  if (auto refusal = refuse_stale(request, etag_of(id, current))) {
    return tl::unexpected(std::move(*refusal));
  }
  return current;
}

Result<Response> removed_response(const Status& removed) {
  if (!removed) {
    return fail(removed.error());
  }
  Response response;
  response.status = 204;
  return response;
}

Result<Response> remove_shown(const Request& request, const Result<Response>& shown,
                              const std::function<Status()>& remove) {
  if (!shown) {
    const bool damaged = !damaged_row_of(shown.error()).empty();
    return damaged && request.header("if-match").value_or("*") == "*" ? removed_response(remove())
                                                                      : fail(shown.error());
  }
  if (auto refusal = refuse_other_content(request, *shown)) {
    return std::move(*refusal);
  }
  return removed_response(remove());
}

Result<std::optional<std::string>> device_filter(Store& store, const Request& request) {
  const auto name = request.parameter("device");
  if (!name) {
    return std::optional<std::string>{};
  }
  auto device = store.device(*name);
  if (!device) {
    return fail(device.error());
  }
  return std::optional<std::string>{device->id};
}

Result<std::optional<JobState>> state_filter(const Request& request) {
  const auto name = request.parameter("state");
  if (!name) {
    return std::optional<JobState>{};
  }
  const std::optional<JobState> state = parse_job_state(*name);
  if (!state) {
    return fail(ErrorCode::InvalidArgument, "The state must be queued, running, succeeded, failed, cancelled or dead.",
                {{"parameter", "state"}});
  }
  return state;
}

void limit_text(std::string_view text, std::string_view budget, std::int64_t most, const std::string& pointer,
                Faults& faults) {
  if (text.size() > static_cast<std::size_t>(most)) {
    faults.add(
        pointer, ErrorCode::LimitExceeded,
        "This text of " + std::to_string(text.size()) + " bytes is too long " + naming_budget(budget, most) + ".");
  }
}

}  // namespace driftlab::server
