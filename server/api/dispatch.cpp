#include "server/api/api.hpp"
#include "server/api/documents.hpp"
#include "server/http/guard.hpp"
#include "server/http/problem.hpp"
#include "server/store/digest.hpp"

#include <algorithm>
#include <mutex>

namespace driftlab::server {
namespace {

/// Takes a key out of the in-flight list on every way out.
class InFlight {
 public:
  InFlight(std::mutex& mutex, std::vector<std::string>& keys, std::string key)
      : mutex_(mutex), keys_(keys), key_(std::move(key)) {
    const std::lock_guard lock(mutex_);
    first_ = std::find(keys_.begin(), keys_.end(), key_) == keys_.end();
    if (first_) {
      keys_.push_back(key_);
    }
  }
  InFlight(const InFlight&) = delete;
  InFlight& operator=(const InFlight&) = delete;
  ~InFlight() {
    if (first_) {
      const std::lock_guard lock(mutex_);
      std::erase(keys_, key_);
    }
  }
  [[nodiscard]] bool first() const { return first_; }

 private:
  std::mutex& mutex_;
  std::vector<std::string>& keys_;
  std::string key_;
  bool first_ = false;
};

Response run_handler(const Handler& handler, const Request& request) {
  auto answer = handler(request);
  return answer ? std::move(*answer) : problem_response(answer.error());
}

Response replay(const IdempotentReply& reply) {
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

void add_etag(const Request& request, Response& response) {
  const bool readable = (request.method == "GET" || request.method == "HEAD") && response.status == 200;
  if (!readable) {
    return;
  }
  std::string etag;
  for (const auto& [name, value] : response.headers) {
    if (name == "ETag") {
      etag = value;
    }
  }
  if (etag.empty()) {
    etag = '"';
    etag.append(sha256_hex(response.body + response.content_type), 0, 32);
    etag += '"';
    response.headers.emplace_back("ETag", etag);
  }
  const auto known = request.header("if-none-match");
  if (known && (*known == "*" || known->find(etag) != std::string_view::npos)) {
    response.status = 304;
    response.body.clear();
  }
}

}  // namespace

Response Dispatcher::run(const Route& route, const Request& request) {
  const auto& handler = std::get<Handler>(route.handler);
  try {
    const auto key = request.method == "POST" ? request.header("idempotency-key") : std::nullopt;
    Response response = key ? run_idempotent(handler, request, std::string(*key)) : run_handler(handler, request);
    add_etag(request, response);
    return response;
  } catch (const std::bad_alloc&) {
    return problem_response(HttpFault::Busy, "There is not enough memory for this request now.");
  } catch (const std::exception& unforeseen) {
    return problem_response(Error{ErrorCode::Internal, std::string("Unforeseen: ") + unforeseen.what() + ".", {}});
  }
}

Response Dispatcher::run_idempotent(const Handler& handler, const Request& request, const std::string& key) {
  if (!is_request_id(key)) {
    return problem_response(HttpFault::BadRequest, "An Idempotency-Key is 1 to 64 of the characters A-Z a-z 0-9 . _ -");
  }
  const InFlight flight(mutex_, in_flight_, key);
  if (!flight.first()) {
    return problem_response(HttpFault::IdempotencyInFlight, "A request with this Idempotency-Key is running.");
  }
  const std::string digest = sha256_hex(request.body);
  auto known = context_.store.idempotent_reply(key);
  if (!known) {
    return problem_response(known.error());
  }
  if (*known) {
    const IdempotentReply& reply = **known;
    if (reply.method != request.method || reply.target != request.target || reply.body_sha256 != digest) {
      return problem_response(HttpFault::IdempotencyKeyReused, "The Idempotency-Key belongs to another request.");
    }
    return replay(reply);
  }
  Response response = run_handler(handler, request);
  if (response.status >= 200 && response.status < 300) {
    Json headers = Json::object();
    for (const auto& [name, value] : response.headers) {
      headers[name] = value;
    }
    const Status remembered =
        context_.store.remember_reply({key, request.method, request.target, digest, response.status, to_text(headers),
                                       response.body, context_.clock.now()});
    if (!remembered) {
      return problem_response(remembered.error());
    }
  }
  return response;
}

void complete_problem(const Request& request, Response& response) {
  if (response.content_type != "application/problem+json") {
    return;
  }
  Json document = stored(response.body);
  if (!document.is_object()) {
    return;
  }
  document["instance"] = request.path.empty() ? request.target : request.path;
  document["request_id"] = request.request_id;
  response.body = to_text(document);
}

void add_all_routes(Router& router, ApiContext& context) {
  add_service_routes(router, context);
  add_device_routes(router, context);
  add_recording_routes(router, context);
  add_job_routes(router, context);
  add_fit_routes(router, context);
  add_parameter_table_routes(router, context);
}

}  // namespace driftlab::server
