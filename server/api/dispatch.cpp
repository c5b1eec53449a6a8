#include "core/signal/text.hpp"
#include "server/api/api.hpp"
#include "server/api/documents.hpp"
#include "server/api/record_blob.hpp"
#include "server/http/compression.hpp"
#include "server/http/guard.hpp"
#include "server/http/names.hpp"
#include "server/http/problem.hpp"
#include "server/store/digest.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace driftlab::server {
namespace {

/// POSTs that are done on a full disk too: they end or secure something, or write to another place.
constexpr std::array<std::string_view, 7> kOnFullDisk{"cancelJob",   "openSession",   "createToken", "rotateToken",
                                                      "revokeToken", "rotateWebhook", "createBackup"};

/// Text for a terminal ends with its line, so that the prompt stands on one of its own.
void end_line(Response& response) {
  const std::string_view type = response.content_type;
  const bool text = type.starts_with("text/") || type.find("json") != std::string_view::npos;
  if (text && !response.body.empty() && response.body.back() != '\n' && !response.has_header("Content-Encoding")) {
    response.body += '\n';
  }
}

Response run_handler(const Handler& handler, const Request& request) {
  auto answer = handler(request);
  Response response = answer ? std::move(*answer) : problem_response(answer.error());
  end_line(response);
  return response;
}

/// application/json, application/merge-patch+json and their like; parameters such as charset do not matter.
bool is_json(std::string_view content_type) {
  const std::string_view type = trimmed(content_type.substr(0, content_type.find(';')));
  const bool suffixed = type.size() > 5 && same_name(type.substr(type.size() - 5), "+json");
  return suffixed || same_name(type, "application/json");
}

bool is_reading(const Request& request) { return request.method == "GET" || request.method == "HEAD"; }

/// The tag of an answer, by its content where the handler gave none.
const std::string& tag(Response& response) {
  for (const auto& [name, value] : response.headers) {
    if (name == "ETag") {
      return value;
    }
  }
  return response.headers.emplace_back("ETag", content_etag(response)).second;
}

/// Whether the client has that representation already.
bool has_it(const Request& request, const std::string& etag) {
  const auto known = request.header("if-none-match");
  return known && (*known == "*" || plain_tag(*known).find(etag) != std::string::npos);
}

/// The answer as it is sent: with its tag, without a body where the client has it, else compressed.
void finish(const Request& request, Response& response) {
  if (is_reading(request) && response.status == 200 && !response.volatile_body && has_it(request, tag(response))) {
    response.status = 304;
    response.body.clear();
    response.file.reset();
  }
  compress(request, response);
}

}  // namespace

Dispatcher::Dispatcher(ApiContext& context)
    : context_(context), answers_(static_cast<std::size_t>(context.budgets.answer_cache_bytes)) {}

Response Dispatcher::run(const Route& route, const Request& request) {
  try {
    return run_checked(route, request);
  } catch (const std::bad_alloc&) {
    return problem_response(HttpFault::Busy, "There is not enough memory for this request now.");
  } catch (const std::exception& unforeseen) {
    return problem_response(Error{ErrorCode::Internal, std::string("Unforeseen: ") + unforeseen.what() + ".", {}});
  }
}

Response Dispatcher::run_checked(const Route& route, const Request& request) {
  // A page of another origin may send a body without a type, or with one of a form, and no browser asks before.
  const std::string_view type = request.header("content-type").value_or("");
  if (!request.body.empty() && !is_json(type)) {
    return problem_response(HttpFault::UnsupportedMediaType,
                            "The body must be application/json" +
                                (type.empty() ? "; name it in Content-Type." : ", not '" + std::string(type) + "'."));
  }
  const auto& handler = std::get<Handler>(route.handler);
  if (route.from_rows && is_reading(request)) {
    return read_rows(handler, request);
  }
  const auto key = request.method == "POST" ? request.header("idempotency-key") : std::nullopt;
  if (key && route.secret) {
    return problem_response(Error{ErrorCode::InvalidArgument,
                                  "The answer holds a secret and is kept nowhere; send no Idempotency-Key.",
                                  {{"parameter", "Idempotency-Key"}}});
  }
  Response response = key ? run_idempotent(route, request, std::string(*key)) : make(route, request);
  finish(request, response);
  return response;
}

Response Dispatcher::read_rows(const Handler& handler, const Request& request) {
  const std::uint64_t changes = context_.store.changes();  // before the first row is read
  const std::string key = answer_key(request);
  if (const auto kept = answers_.find(key, changes)) {
    return give_kept(key, changes, request, *kept);
  }
  Response response = run_handler(handler, request);
  if (response.status != 200 || !response.pending_job.empty()) {
    finish(request, response);
    return response;
  }
  (void)tag(response);
  answers_.keep(key, changes, response);
  return give_kept(key, changes, request, response);
}

Response Dispatcher::give_kept(const std::string& key, std::uint64_t changes, const Request& request,
                               const Response& kept) {
  const auto etag =
      std::find_if(kept.headers.begin(), kept.headers.end(), [](const auto& header) { return header.first == "ETag"; });
  const bool whole = etag == kept.headers.end() || !has_it(request, etag->second);
  if (!whole) {  // its body, which may be megabytes, is not copied only to be left out
    Response response;
    response.status = 304;
    response.content_type = kept.content_type;
    response.headers = kept.headers;
    compress(request, response);
    return response;
  }
  if (!takes_gzip(request)) {
    Response response = kept;
    finish(request, response);
    return response;
  }
  const std::string packed_key = key + "\ngzip";
  if (const auto packed = answers_.find(packed_key, changes)) {
    return *packed;
  }
  Response response = kept;
  finish(request, response);
  answers_.keep(packed_key, changes, response);
  return response;
}

std::optional<Response> Dispatcher::known(const Route& route, const Request& request) {
  if (!route.from_rows || !is_reading(request)) {
    return std::nullopt;
  }
  const std::uint64_t changes = context_.store.changes();
  const std::string key = answer_key(request);
  const auto kept = answers_.find(key, changes);
  if (!kept) {
    return std::nullopt;
  }
  return give_kept(key, changes, request, *kept);
}

Response Dispatcher::make(const Route& route, const Request& request) {
  const bool creates = request.method == "POST" &&
                       std::find(kOnFullDisk.begin(), kOnFullDisk.end(), route.operation_id) == kOnFullDisk.end();
  if (const Status room = creates ? require_space(context_) : Status{}; !room) {
    return problem_response(room.error());
  }
  return run_handler(std::get<Handler>(route.handler), request);
}

Response Dispatcher::run_idempotent(const Route& route, const Request& request, const std::string& key) {
  if (!is_request_id(key)) {
    return problem_response(malformed_idempotency_key());
  }
  const std::string own = own_key(request, key);
  const auto flight = context_.keys_in_flight.take(own);
  if (!flight) {
    return problem_response(flight.error());
  }
  if (*flight == nullptr) {
    return problem_response(HttpFault::IdempotencyInFlight, "A request with this Idempotency-Key is running.");
  }
  const std::string digest = sha256_hex(request.body);
  auto known = context_.store.idempotent_reply(own);
  if (!known) {
    return problem_response(known.error());
  }
  if (const std::optional<IdempotentReply>& reply = *known) {
    return replay_whole(context_, *reply, request, digest);
  }
  Response response = make(route, request);
  if (response.status >= 200 && response.status < 300) {
    const Status remembered =
        context_.store.remember_reply(reply_to_remember(own, request, digest, response, context_.clock.now()));
    if (!remembered) {
      return problem_response(remembered.error());
    }
  }
  return response;
}

Response replay_whole(const ApiContext& context, const IdempotentReply& reply, const Request& request,
                      const std::string& body_sha256) {
  Response response = replay(reply, request, body_sha256);
  const auto location = std::find_if(response.headers.begin(), response.headers.end(),
                                     [](const auto& header) { return header.first == "Location"; });
  if (!response.body.empty() || location == response.headers.end() || !context.read) {
    return response;
  }
  Request again;
  again.method = "GET";
  again.target = location->second;
  again.path = location->second;
  again.caller = request.caller;
  again.request_id = request.request_id;
  again.budgets = request.budgets;
  Response now = context.read(again);
  if (now.status != 200) {
    return now;
  }
  std::erase_if(response.headers, [](const auto& header) { return header.first == "ETag"; });
  for (const auto& header : now.headers) {
    if (header.first == "ETag") {
      response.headers.push_back(header);
    }
  }
  response.body = std::move(now.body);
  response.content_type = std::move(now.content_type);
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
  response.body = to_text(document) + "\n";
}

}  // namespace driftlab::server
