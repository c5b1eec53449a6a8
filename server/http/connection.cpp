#include "server/http/connection.hpp"

#include "core/signal/text.hpp"
#include "server/http/answer_head.hpp"
#include "server/http/forwarded.hpp"
#include "server/store/network.hpp"

#include <boost/beast/http/read.hpp>

#include <algorithm>

namespace driftlab::server {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = boost::beast::http;
using namespace std::chrono_literals;

namespace {

/// For the first bytes of a request; what its header needs beyond comes when it is there. A silent connection holds no
/// more.
constexpr std::size_t kFirstBytes = 1024;
constexpr auto kUnaskedWait = 20s;
/// A body of that many bytes goes out in one piece with the head, which costs a copy of it and saves a call.
constexpr std::size_t kSentWithHead = 16UL * 1024;

HeadView head_of(const http::request<http::buffer_body>& message) {
  HeadView head;
  head.version = message.version();
  head.method = {message.method_string().data(), message.method_string().size()};
  head.target = {message.target().data(), message.target().size()};
  for (const auto& field : message) {
    const std::string_view name(field.name_string().data(), field.name_string().size());
    head.headers.emplace_back(lower_case(name), std::string(field.value()));
  }
  return head;
}

/// How long to wait for another answer than this one. Only reading is repeated, and what was refused until the job has
/// ended: another POST asked again could queue a second job. The refusal is avoided also for a client that says
/// nothing.
std::chrono::seconds patience_for(const Request& request, const Response& response) {
  const bool reads = request.method == "GET" || request.method == "HEAD";
  if (response.pending_job.empty() || !(reads || response.undone)) {
    return 0s;
  }
  return preferred_wait(request).value_or(response.undone ? kUnaskedWait : 0s);
}

}  // namespace

HttpConnection::HttpConnection(asio::ip::tcp::socket socket, std::shared_ptr<asio::ssl::context> tls,
                               ConnectionShared& shared)
    : stream_(std::move(socket), std::move(tls)),
      buffer_(static_cast<std::size_t>(shared.options.budgets.header_bytes) + kBodyPiece),
      shared_(shared) {
  boost::system::error_code error;
  const auto peer = stream_.socket().remote_endpoint(error);
  address_ = error ? "" : plain_text(peer.address());
}

asio::awaitable<void> HttpConnection::run() {
  begin_waiting();  // whoever never says hello waits like any other, and makes place like any other
  const bool shaken = co_await stream_.handshake(10s);
  if (!shaken) {
    co_return;
  }
  for (std::int64_t served = 0; served < budgets().requests_per_connection && !shared_.stopping; ++served) {
    Parser parser;
    parser.header_limit(static_cast<std::uint32_t>(budgets().header_bytes));
    parser.body_limit(boost::none);
    const bool read = co_await read_header(parser);
    if (!read) {
      break;
    }
    keep_alive_ = parser.get().keep_alive() && served + 1 < budgets().requests_per_connection;
    const bool again = co_await answer(parser);
    if (!again) {
      break;
    }
  }
  co_await stream_.say_goodbye();
  abandon();
}

void HttpConnection::abandon() {
  boost::system::error_code ignored;
  ignored = stream_.socket().shutdown(asio::ip::tcp::socket::shutdown_both, ignored);
}

void HttpConnection::close_if_idle() {
  if (idle_since_ != 0) {
    stream_.cancel();
  }
}

std::optional<std::chrono::steady_clock::time_point> HttpConnection::idle_since() const {
  const std::int64_t since = idle_since_;
  if (since == 0 || leaving_) {
    return std::nullopt;
  }
  return std::chrono::steady_clock::time_point(std::chrono::steady_clock::duration(since));
}

void HttpConnection::begin_waiting() { idle_since_ = std::chrono::steady_clock::now().time_since_epoch().count(); }

asio::awaitable<bool> HttpConnection::read_header(Parser& parser) {
  boost::system::error_code error;
  begin_waiting();
  if (buffer_.size() == 0) {
    buffer_.shrink_to_fit();
    std::vector<std::byte>().swap(chunk_);
    stream_.expires_after(std::chrono::seconds(budgets().idle_seconds));
    const std::size_t count = co_await stream_.async_read_some(buffer_.prepare(kFirstBytes), into(error));
    if (error) {
      co_return false;
    }
    buffer_.commit(count);
  }
  started_ = std::chrono::steady_clock::now();
  route_.clear();
  client_ = address_;
  bytes_in_ = 0;
  for_client_ = {};
  broken_ = false;
  folded_ = false;
  chunked_.reset();
  framing_fault_.clear();
  stream_.expires_after(std::chrono::seconds(budgets().header_seconds));
  for (std::size_t looked_at = 0; !error && !folded_;) {
    const std::string_view arrived(static_cast<const char*>(buffer_.data().data()), buffer_.size());
    const HeadArrival head = look_at_head(arrived, looked_at);
    folded_ = head.folded;
    looked_at = arrived.size();
    const auto most = static_cast<std::size_t>(budgets().header_bytes);
    if (head.whole || head.folded || looked_at >= most) {
      break;  // the parser says the rest
    }
    const std::size_t count =
        co_await stream_.async_read_some(buffer_.prepare(std::min(most - looked_at, 4 * kFirstBytes)), into(error));
    buffer_.commit(error ? 0 : count);
  }
  if (!error && !folded_) {
    co_await http::async_read_header(stream_, buffer_, parser, into(error));
  }
  idle_since_ = 0;
  if (folded_) {
    Request request;
    request.request_id = shared_.hooks.make_request_id();
    co_await refuse(request, problem_response(HttpFault::BadRequest,
                                              "A line of the header goes on in the next one; such folded lines are "
                                              "obsolete and read differently by different programs."));
    co_return false;
  }
  if (!error) {
    co_return true;
  }
  const bool gone = error == http::error::end_of_stream || error == beast::error::timeout ||
                    error == asio::error::connection_reset || error == asio::error::operation_aborted ||
                    error == http::error::partial_message || error == asio::error::eof;
  if (!gone) {
    Request request;
    request.request_id = shared_.hooks.make_request_id();
    Response response =
        error == http::error::header_limit || error == http::error::buffer_overflow
            ? problem_response(HttpFault::HeaderTooLarge, "The request header is larger than it may be " +
                                                              naming_budget("header_bytes", budgets().header_bytes) +
                                                              ".")
            : problem_response(HttpFault::BadRequest, "The request is not well-formed HTTP: " + error.message() + ".");
    co_await refuse(request, std::move(response));
  }
  co_return false;
}

asio::awaitable<bool> HttpConnection::answer(Parser& parser) {
  HeadView head = head_of(parser.get());
  Request request;
  request.budgets = &budgets();
  request.method = head.method;
  request.target = head.target;
  const GuardVerdict verdict = inspect(head, shared_.options.guard);
  request.headers = std::move(head.headers);
  const auto given_id = request.header("x-request-id");
  request.request_id = given_id && is_request_id(*given_id) ? std::string(*given_id) : shared_.hooks.make_request_id();
  request.caller.request_id = request.request_id;
  client_ = client_address(address_, request.headers, shared_.options.proxies);
  request.caller.address = client_;
  wants_continue_ = verdict.expects_continue;
  const bool has_body = verdict.content_length > 0 || verdict.chunked;
  body_unread_ = has_body || verdict.refusal.has_value();

  std::optional<Response> refusal = verdict.refusal;
  auto target = parse_target(request.target);
  Router::Match match;
  if (!refusal && !target) {
    refusal = problem_response(HttpFault::BadRequest, "The request target is malformed.");
  }
  if (!refusal) {
    request.path = std::move(target->path);
    request.query = std::move(target->query);
    if (shared_.hooks.page && !has_body && !admit(nullptr, request)) {
      if (auto page = shared_.hooks.page(request)) {
        route_ = "page";
        co_return co_await send(request, std::move(*page), true);
      }
    }
    match = shared_.router.match(request.method, request.path);
    request.parameters = std::move(match.parameters);
    if (match.allowed.empty()) {
      refusal = problem_response(HttpFault::NoSuchResource, "There is no resource at " + request.path + ".");
    } else if (match.route == nullptr) {
      refusal = problem_response(HttpFault::MethodNotAllowed, "The resource has no method " + request.method + ".");
      std::string allow;
      for (const std::string_view method : match.allowed) {
        allow += (allow.empty() ? "" : ", ") + std::string(method) + (method == "GET" ? ", HEAD" : "");
      }
      refusal->headers.emplace_back("Allow", allow);
    } else {
      refusal = admit(match.route, request);
      if (!refusal) {
        refusal = refuse_unknown_query(*match.route, request);
      }
      if (!refusal && verdict.chunked && !std::holds_alternative<UploadHandler>(match.route->handler)) {
        refusal =
            problem_response(HttpFault::LengthRequired, "This resource takes no chunked body; send Content-Length.");
      }
    }
  }
  if (refusal) {
    const bool intact = !has_body && !verdict.refusal;
    const bool again = co_await send(request, std::move(*refusal), intact);
    if (!intact) {
      co_await linger();
    }
    co_return again;
  }

  route_ = match.route->pattern;
  const auto place = shared_.in_flight.enter(request.caller.principal.token);
  if (!place) {
    Response full = problem_response(HttpFault::TooManyRequests,
                                     "The token has as many requests under way as it may have " +
                                         naming_budget("requests_per_token", budgets().requests_per_token) + ".");
    if (has_body) {
      co_return co_await refuse(request, std::move(full));
    }
    co_return co_await send(request, std::move(full), true);
  }
  if (verdict.chunked) {
    chunked_.emplace();
  }
  if (const auto* const upload = std::get_if<UploadHandler>(&match.route->handler)) {
    co_return co_await answer_upload(parser, *upload, request);
  }
  if (const auto* const events = std::get_if<EventHandler>(&match.route->handler)) {
    co_return co_await answer_events(*events, request);
  }
  co_return co_await answer_plain(parser, *match.route, request);
}

std::optional<Response> HttpConnection::admit(const Route* route, Request& request) const {
  return shared_.hooks.admit ? shared_.hooks.admit(route, request) : std::nullopt;
}

asio::awaitable<bool> HttpConnection::answer_plain(Parser& parser, const Route& route, Request& request) {
  const auto declared = parser.content_length();
  if (declared && *declared > static_cast<std::uint64_t>(budgets().document_bytes)) {
    Response too_large =
        problem_response(HttpFault::BodyTooLarge, "A document may not be that large " +
                                                      naming_budget("document_bytes", budgets().document_bytes) + ".");
    co_return co_await refuse(request, std::move(too_large));
  }
  while (true) {
    const auto count = co_await read_piece(parser);
    if (!count) {
      co_await send(request, incomplete_body(), false);
      co_return false;
    }
    if (*count == 0) {
      break;
    }
    request.body.append(reinterpret_cast<const char*>(chunk_.data()), *count);
  }
  std::optional<Response> outcome;
  if (shared_.hooks.known) {
    outcome = shared_.hooks.known(route, request);
  }
  if (!outcome) {
    outcome = co_await dispatch_in_lane(route, request);
  }
  Response response = outcome ? std::move(*outcome) : too_many_waiting(budgets());
  if (patience_for(request, response) > 0s) {
    response = co_await wait_for_job(route, request, std::move(response));
  }
  co_return co_await send(request, std::move(response), true);
}

Response HttpConnection::dispatch(const Route& route, const Request& request) const {
  const ActingFor acting(request.caller);
  return shared_.hooks.dispatch(route, request);
}

asio::awaitable<std::optional<Response>> HttpConnection::dispatch_in_lane(const Route& route, const Request& request) {
  auto work = [this, &route, &request] { return dispatch(route, request); };
  std::optional<Response> outcome;
  switch (route.lane) {
    case Lane::Instant:
      outcome = work();
      break;
    case Lane::Prompt:
      outcome = co_await shared_.handlers.run(work);
      break;
    case Lane::Slow:
      outcome = co_await shared_.slow.run(work);
      break;
    case Lane::Decoding:
      outcome = co_await dispatch_decoding(route, request);
      break;
  }
  co_return outcome;
}

asio::awaitable<Response> HttpConnection::wait_for_job(const Route& route, const Request& request, Response response) {
  const auto deadline = std::chrono::steady_clock::now() + patience_for(request, response);
  const auto executor = co_await asio::this_coro::executor;
  const auto listener = shared_.bell.listen(response.pending_job, executor);
  while (patience_for(request, response) > 0s && !shared_.stopping && still_admitted(request)) {
    const auto left = deadline - std::chrono::steady_clock::now();
    if (left <= 0s) {
      break;
    }
    {
      const Timed as_asked(for_client_);
      co_await listener->wait(std::min<std::chrono::steady_clock::duration>(left, 1s));
    }
    auto outcome = co_await dispatch_in_lane(route, request);
    if (outcome) {
      response = std::move(*outcome);
    }
  }
  if (const auto asked = preferred_wait(request)) {
    response.headers.emplace_back("Preference-Applied", "wait=" + std::to_string(asked->count()));
  }
  co_return response;
}

bool HttpConnection::still_admitted(const Request& request) const {
  return !shared_.hooks.still_admitted || shared_.hooks.still_admitted(request.caller.principal);
}

asio::awaitable<bool> HttpConnection::refuse(const Request& request, Response response) {
  co_await send(request, std::move(response), false);
  co_await linger();
  co_return false;
}

asio::awaitable<bool> HttpConnection::send(const Request& request, Response response, bool keep_alive) {
  shared_.hooks.complete(request, response);
  log(request, response);
  const bool goes_on = keep_alive && keep_alive_ && !body_unread_ && !shared_.stopping;
  const std::uint64_t length = response.file ? response.file->length : response.body.size();
  std::string text = answer_head(response, {request.request_id, length, !goes_on});
  const bool with_body = request.method != "HEAD" && has_content(response.status);
  const bool in_one = with_body && response.body.size() <= kSentWithHead;
  if (in_one) {
    text += response.body;
  }
  bool sent = co_await write_text(text);
  if (sent && with_body && !in_one) {
    sent = co_await write_text(response.body);
  }
  if (sent && with_body && response.file) {
    sent = co_await send_file(*response.file);
  }
  co_return sent&& goes_on;
}

asio::awaitable<void> HttpConnection::linger() {
  boost::system::error_code error;
  error = stream_.socket().shutdown(asio::ip::tcp::socket::shutdown_send, error);
  const auto until = std::chrono::steady_clock::now() + 2s;
  if (chunk_.empty()) {
    chunk_.resize(kFirstBytes);
  }
  while (!error && std::chrono::steady_clock::now() < until) {
    stream_.expires_at(until);
    co_await stream_.below().async_read_some(asio::buffer(chunk_), into(error));
  }
}

void HttpConnection::log(const Request& request, const Response& response) {
  if (!shared_.hooks.log) {
    return;
  }
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - started_).count();
  shared_.hooks.log({request.method, route_, request.target, response.status, bytes_in_,
                     response.file ? response.file->length : response.body.size(), seconds,
                     std::chrono::duration<double>(for_client_).count(), request.request_id, client_,
                     request.caller.principal.token, response.failure});
}

}  // namespace driftlab::server
