// Uploads: the body of one request as it streams into a session on the upload pool.
#include "server/http/connection.hpp"

#include <algorithm>
#include <chrono>
#include <optional>
#include <utility>

namespace driftlab::server {

namespace asio = boost::asio;

namespace {

Result<Response> finish_upload(UploadSession& session) {
  try {
    return session.finish();
  } catch (const std::bad_alloc&) {
    return problem_response(HttpFault::Busy, "There is not enough memory for this upload now.");
  } catch (const std::exception& unforeseen) {
    return fail(ErrorCode::Internal, std::string("Unforeseen: ") + unforeseen.what() + ".");
  }
}

/// Gives an upload's place back when it ends, and wakes those who wait for one.
struct UploadPlace {
  UploadPlaces& places;
  Bell& bell;
  UploadPlaces::Number number;
  UploadPlace(UploadPlaces& given, Bell& to_ring, UploadPlaces::Number own)
      : places(given), bell(to_ring), number(own) {}
  UploadPlace(const UploadPlace&) = delete;
  UploadPlace& operator=(const UploadPlace&) = delete;
  ~UploadPlace() {
    places.leave(number);
    bell.ring(std::string(UploadPlaces::kSubject));
  }
};

}  // namespace

std::optional<Response> HttpConnection::refuse_ended(const Request& request) const {
  // What is for everybody was admitted without a token.
  if (request.caller.principal.scope == Scope::Public || still_admitted(request)) {
    return std::nullopt;
  }
  Response response = problem_response(
      HttpFault::Unauthorized, "The token was revoked, or expired, before the upload had ended; it was not taken.");
  response.headers.emplace_back("WWW-Authenticate", "Bearer realm=\"driftlab\", error=\"invalid_token\"");
  return response;
}

asio::awaitable<std::optional<Response>> HttpConnection::wait_for_place(const Request& request,
                                                                        UploadPlaces::Number number) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(budgets().upload_wait_seconds);
  const auto executor = co_await asio::this_coro::executor;
  const auto listener = shared_.bell.listen(std::string(UploadPlaces::kSubject), executor);
  while (!shared_.upload_places.has_place(number)) {
    if (shared_.stopping) {
      co_return problem_response(HttpFault::Busy, "The daemon stops; the upload had not begun.");
    }
    if (auto ended = refuse_ended(request)) {
      co_return ended;
    }
    const auto left = deadline - std::chrono::steady_clock::now();
    if (left <= std::chrono::seconds(0)) {
      co_return problem_response(HttpFault::Busy,
                                 "Other uploads had every place for as long as one may wait " +
                                     naming_budget("upload_wait_seconds", budgets().upload_wait_seconds) + ".");
    }
    co_await listener->wait(std::min<std::chrono::steady_clock::duration>(left, std::chrono::seconds(1)));
  }
  co_return std::nullopt;
}

std::optional<Response> HttpConnection::refuse_before_upload(const Parser& parser) const {
  const auto declared = parser.content_length();
  if (!declared && !chunked_) {
    return problem_response(HttpFault::LengthRequired, "An upload needs Content-Length, or comes chunked.");
  }
  if (declared && *declared > static_cast<std::uint64_t>(budgets().upload_bytes)) {
    return too_large();
  }
  return std::nullopt;
}

Response HttpConnection::too_many_uploads() const {
  return problem_response(HttpFault::Busy, "Too many uploads are waiting " +
                                               naming_budget("uploads_waiting", budgets().uploads_waiting) + ".");
}

Response HttpConnection::too_large() const {
  return problem_response(HttpFault::BodyTooLarge, "An upload may not be that large " +
                                                       naming_budget("upload_bytes", budgets().upload_bytes) + ".");
}

asio::awaitable<bool> HttpConnection::answer_upload(Parser& parser, const UploadHandler& handler, Request& request) {
  // The upload's place and session are given back before the answer is sent.
  tl::expected<Response, Response> taken = co_await take_upload(parser, handler, request);
  if (!taken) {
    co_return co_await refuse(request, std::move(taken.error()));
  }
  co_return co_await send(request, std::move(*taken), true);
}

asio::awaitable<tl::expected<Response, Response>> HttpConnection::take_upload(Parser& parser,
                                                                              const UploadHandler& handler,
                                                                              Request& request) {
  std::optional<Response> refusal = refuse_before_upload(parser);
  if (refusal) {
    co_return tl::unexpected(std::move(*refusal));
  }
  const auto declared = parser.content_length();
  const auto number = shared_.upload_places.join({request.caller.principal.token, client_, declared.value_or(0)},
                                                 std::chrono::steady_clock::now());
  if (!number) {
    co_return tl::unexpected(too_many_uploads());
  }
  const UploadPlace place(shared_.upload_places, shared_.bell, *number);
  refusal = co_await wait_for_place(request, *number);
  if (refusal) {
    co_return tl::unexpected(std::move(*refusal));
  }
  auto begin = [&handler, &request] {
    const ActingFor acting(request.caller);
    return handler(request);
  };
  auto begun = co_await shared_.uploads.run(begin);
  auto settled = settle(std::move(begun), budgets());
  if (!settled) {
    co_return tl::unexpected(std::move(settled.error()));
  }
  const std::unique_ptr<UploadSession> session = std::move(*settled);
  refusal = co_await receive(parser, request, *session);
  if (refusal) {
    co_return tl::unexpected(std::move(*refusal));
  }
  auto finish = [this, &session, &request]() -> Result<Response> {
    if (auto ended = refuse_ended(request)) {  // now that its turn has come
      return std::move(*ended);
    }
    const ActingFor acting(request.caller);
    return finish_upload(*session);
  };
  auto finished = co_await shared_.decodings.run(finish);
  auto answered = settle(std::move(finished), budgets());
  Response answer = answered ? std::move(*answered) : std::move(answered.error());
  co_return answer;
}

asio::awaitable<std::optional<Response>> HttpConnection::dispatch_decoding(const Route& route, const Request& request) {
  const auto number =
      shared_.upload_places.join({request.caller.principal.token, client_, 0}, std::chrono::steady_clock::now());
  if (!number) {
    co_return too_many_uploads();
  }
  const UploadPlace place(shared_.upload_places, shared_.bell, *number);
  std::optional<Response> refusal = co_await wait_for_place(request, *number);
  if (refusal) {
    co_return refusal;
  }
  auto work = [this, &route, &request] { return dispatch(route, request); };
  co_return co_await shared_.decodings.run(work);
}

asio::awaitable<std::optional<Response>> HttpConnection::receive(Parser& parser, const Request& request,
                                                                 UploadSession& session) {
  auto admitted_at = std::chrono::steady_clock::now();
  while (true) {
    const auto count = co_await read_piece(parser);
    if (!count) {
      co_return incomplete_body();
    }
    if (bytes_in_ > static_cast<std::uint64_t>(budgets().upload_bytes)) {
      co_return too_large();
    }
    if (*count == 0) {
      break;
    }
    if (const auto now = std::chrono::steady_clock::now(); now - admitted_at > std::chrono::seconds(1)) {
      admitted_at = now;
      if (auto ended = refuse_ended(request)) {
        co_return ended;
      }
    }
    auto append = [this, &session, size = *count] { return session.append({chunk_.data(), size}); };
    auto appended = co_await shared_.uploads.run(append);
    auto taken = settle(std::move(appended), budgets());
    if (!taken) {
      co_return std::move(taken.error());
    }
  }
  if (!chunked_ && surplus_follows()) {
    co_return problem_response(HttpFault::BadRequest, "More bytes follow than the Content-Length of " +
                                                          std::to_string(*parser.content_length()) +
                                                          " declares; nothing was kept.");
  }
  co_return std::nullopt;
}

bool HttpConnection::surplus_follows() {
  boost::system::error_code error;
  if (buffer_.size() == 0 && stream_.is_tls()) {
    const std::size_t waiting = std::min(stream_.decrypted(), chunk_.size());
    buffer_.commit(waiting > 0 ? stream_.read_decrypted(buffer_.prepare(waiting), error) : 0);
  } else if (buffer_.size() == 0 && stream_.socket().available(error) > 0 && !error) {
    error = stream_.socket().non_blocking(true, error);
    const std::size_t count = stream_.socket().read_some(buffer_.prepare(chunk_.size()), error);
    buffer_.commit(error ? 0 : count);
  }
  const std::string_view next(static_cast<const char*>(buffer_.data().data()), buffer_.size());
  if (next.empty()) {
    return false;
  }
  // A pipelined request begins with an upper-case method, a space and a slash.
  const std::size_t end = std::min(next.find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZ"), next.size());
  const std::string_view rest = next.substr(end);
  const bool may_be_request = end > 0 && (rest.empty() || rest == " " || rest.starts_with(" /"));
  return !may_be_request;
}

}  // namespace driftlab::server
