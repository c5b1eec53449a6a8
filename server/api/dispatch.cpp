#include "core/signal/text.hpp"
#include "server/api/api.hpp"
#include "server/api/documents.hpp"
#include "server/http/compression.hpp"
#include "server/http/guard.hpp"
#include "server/http/problem.hpp"
#include "server/store/digest.hpp"

#include <boost/beast/core/string.hpp>

namespace driftlab::server {
namespace {

Response run_handler(const Handler& handler, const Request& request) {
  auto answer = handler(request);
  return answer ? std::move(*answer) : problem_response(answer.error());
}

/// application/json, application/merge-patch+json and their like; parameters such as charset do not matter.
bool is_json(std::string_view content_type) {
  const std::string_view type = trimmed(content_type.substr(0, content_type.find(';')));
  const bool suffixed = type.size() > 5 && boost::beast::iequals(type.substr(type.size() - 5), "+json");
  return suffixed || boost::beast::iequals(type, "application/json");
}

void add_etag(const Request& request, Response& response) {
  const bool readable = (request.method == "GET" || request.method == "HEAD") && response.status == 200;
  if (!readable || request.path == "/metrics") {  // metrics count this very request: they are never what they were
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
  if (known && (*known == "*" || plain_tag(*known).find(etag) != std::string::npos)) {
    response.status = 304;
    response.body.clear();
  }
}

}  // namespace

Response Dispatcher::run(const Route& route, const Request& request) {
  // A page of another origin may send a body without a type, or with one of a form, and no browser asks before.
  const std::string_view type = request.header("content-type").value_or("");
  if (!request.body.empty() && !is_json(type)) {
    return problem_response(HttpFault::UnsupportedMediaType,
                            "The body must be application/json" +
                                (type.empty() ? "; name it in Content-Type." : ", not '" + std::string(type) + "'."));
  }
  const auto& handler = std::get<Handler>(route.handler);
  try {
    const auto key = request.method == "POST" ? request.header("idempotency-key") : std::nullopt;
    if (key && route.secret) {
      return problem_response(Error{ErrorCode::InvalidArgument,
                                    "The answer holds a secret and is kept nowhere; send no Idempotency-Key.",
                                    {{"parameter", "Idempotency-Key"}}});
    }
    Response response = key ? run_idempotent(handler, request, std::string(*key)) : run_handler(handler, request);
    add_etag(request, response);
    compress(request, response);
    return response;
  } catch (const std::bad_alloc&) {
    return problem_response(HttpFault::Busy, "There is not enough memory for this request now.");
  } catch (const std::exception& unforeseen) {
    return problem_response(Error{ErrorCode::Internal, std::string("Unforeseen: ") + unforeseen.what() + ".", {}});
  }
}

Response Dispatcher::run_idempotent(const Handler& handler, const Request& request, const std::string& key) {
  if (!is_request_id(key)) {
    return problem_response(malformed_idempotency_key());
  }
  const std::string own = own_key(request, key);
  const auto flight = context_.keys_in_flight.take(own);
  if (!flight) {
    return problem_response(HttpFault::IdempotencyInFlight, "A request with this Idempotency-Key is running.");
  }
  const std::string digest = sha256_hex(request.body);
  auto known = context_.store.idempotent_reply(own);
  if (!known) {
    return problem_response(known.error());
  }
  if (const std::optional<IdempotentReply>& reply = *known) {
    return replay(*reply, request, digest);
  }
  Response response = run_handler(handler, request);
  if (response.status >= 200 && response.status < 300) {
    const Status remembered =
        context_.store.remember_reply(reply_to_remember(own, request, digest, response, context_.clock.now()));
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
  document["instance"] = request.target.substr(0, request.target.find('?'));
  document["request_id"] = request.request_id;
  response.body = to_text(document);
}

}  // namespace driftlab::server
