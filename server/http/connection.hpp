#pragma once
/// One client connection as a coroutine: header, guard, route, body, answer; again until it closes.
#include "server/http/chunked.hpp"
#include "server/http/client_stream.hpp"
#include "server/http/in_flight.hpp"
#include "server/http/offload.hpp"
#include "server/http/problem.hpp"
#include "server/http/server.hpp"
#include "server/http/upload_places.hpp"

#include <boost/asio/awaitable.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http/buffer_body.hpp>
#include <boost/beast/http/parser.hpp>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

namespace driftlab::server {

/// Bytes of a body that are handed on at once.
inline constexpr std::size_t kBodyPiece = 256UL * 1024;

/// The completion token of an awaited operation whose error is looked at and not thrown.
[[nodiscard]] inline auto into(boost::system::error_code& error) {
  return boost::asio::redirect_error(boost::asio::use_awaitable, error);
}

/// The answer where work found no place in its queue.
[[nodiscard]] inline Response too_many_waiting(const Budgets& budgets) {
  return problem_response(HttpFault::Busy, "Too many requests are waiting " +
                                               naming_budget("requests_waiting", budgets.requests_waiting) + ".");
}

/// What work gave, or the answer where it failed or found no place in its queue.
///
/// GCC 12 destroys the arms of a conditional twice where it stands inside a co_await expression. No such expression
/// here holds one: what is awaited is made in a statement of its own.
template <class Value>
[[nodiscard]] tl::expected<Value, Response> settle(std::optional<Result<Value>> outcome, const Budgets& budgets) {
  if (!outcome) {
    return tl::unexpected(too_many_waiting(budgets));
  }
  return std::move(*outcome).map_error([](const Error& error) { return problem_response(error); });
}

/// What connections share. Outlives them all.
struct ConnectionShared {
  const HttpOptions& options;
  const Router& router;
  Bell& bell;
  const HttpHooks& hooks;
  BoundedPool& handlers;
  BoundedPool& slow;       ///< handlers that read a whole recording
  BoundedPool& uploads;    ///< takes bytes in
  BoundedPool& decodings;  ///< ends uploads, which takes as long as they are large
  std::atomic<bool>& stopping;
  UploadPlaces& upload_places;
  RequestsInFlight& in_flight;
};

/// Adds the time of its life to `sum`.
class Timed {
 public:
  explicit Timed(std::chrono::steady_clock::duration& sum) : sum_(sum), began_(std::chrono::steady_clock::now()) {}
  Timed(const Timed&) = delete;
  Timed& operator=(const Timed&) = delete;
  ~Timed() { sum_ += std::chrono::steady_clock::now() - began_; }

 private:
  std::chrono::steady_clock::duration& sum_;
  std::chrono::steady_clock::time_point began_;
};

class HttpConnection {
 public:
  /// `tls`: the certificate to show, or nullptr for plain HTTP.
  HttpConnection(boost::asio::ip::tcp::socket socket, std::shared_ptr<boost::asio::ssl::context> tls,
                 ConnectionShared& shared);
  /// Runs until the connection closes. Never throws.
  boost::asio::awaitable<void> run();
  /// Closes a connection that waits for its next request. On the connection's own executor.
  void close_if_idle();
  /// Since when it waits for a whole request header, or for the client's part of the handshake; nothing while it is at
  /// work or told to leave. Thread safe.
  [[nodiscard]] std::optional<std::chrono::steady_clock::time_point> idle_since() const;
  /// It is to be closed for want of a place. Thread safe.
  void leave() { leaving_ = true; }
  [[nodiscard]] bool is_leaving() const { return leaving_; }
  /// Closes the socket. On the connection's own executor.
  void abandon();
  [[nodiscard]] const std::string& address() const { return address_; }
  [[nodiscard]] boost::asio::any_io_executor executor() { return stream_.get_executor(); }

 private:
  using Parser = boost::beast::http::request_parser<boost::beast::http::buffer_body>;

  /// From now on it is idle.
  void begin_waiting();
  /// Waits for a header. False: closed, timed out, or answered with a problem.
  boost::asio::awaitable<bool> read_header(Parser& parser);
  /// Answers the request whose header was read. False: the connection must close.
  boost::asio::awaitable<bool> answer(Parser& parser);
  /// Waits until the upload of that number has its place. The answer where it never gets one.
  boost::asio::awaitable<std::optional<Response>> wait_for_place(const Request& request, UploadPlaces::Number number);
  [[nodiscard]] std::optional<Response> admit(const Route* route, Request& request) const;
  [[nodiscard]] bool still_admitted(const Request& request) const;
  boost::asio::awaitable<bool> answer_plain(Parser& parser, const Route& route, Request& request);
  /// The handler's answer, for whoever asks.
  [[nodiscard]] Response dispatch(const Route& route, const Request& request) const;
  /// The same on the threads of its lane. Nothing where too many wait for these.
  boost::asio::awaitable<std::optional<Response>> dispatch_in_lane(const Route& route, const Request& request);
  /// The same with a place among the uploads; the refusal where it never gets one.
  boost::asio::awaitable<std::optional<Response>> dispatch_decoding(const Route& route, const Request& request);
  boost::asio::awaitable<bool> answer_upload(Parser& parser, const UploadHandler& handler, Request& request);
  /// The answer to an upload; unexpected where its body was not read to the end.
  boost::asio::awaitable<tl::expected<Response, Response>> take_upload(Parser& parser, const UploadHandler& handler,
                                                                       Request& request);
  /// Reads the body into the session. The answer where that fails.
  boost::asio::awaitable<std::optional<Response>> receive(Parser& parser, const Request& request,
                                                          UploadSession& session);
  boost::asio::awaitable<bool> answer_events(const EventHandler& handler, const Request& request);
  /// `Prefer: wait=n`: asks again whenever the job moves, until the answer is final or n seconds are over.
  boost::asio::awaitable<Response> wait_for_job(const Route& route, const Request& request, Response response);
  /// Next piece of the body into `chunk_`. Its size; 0 at the end; nothing if the client is gone or too slow.
  boost::asio::awaitable<std::optional<std::size_t>> read_piece(Parser& parser);
  /// The same of a chunked body; what is wrong with its framing stands in `framing_fault_` then.
  boost::asio::awaitable<std::optional<std::size_t>> read_chunk();
  /// The body comes more slowly than it may.
  [[nodiscard]] bool trickles() const;
  /// The answer where `read_piece` gave nothing.
  [[nodiscard]] Response incomplete_body() const;
  /// Bytes that are no further request came after a body: the client sent more than its Content-Length declares.
  [[nodiscard]] bool surplus_follows();
  /// False: the connection must close, for the answer said so or could not be sent.
  boost::asio::awaitable<bool> send(const Request& request, Response response, bool keep_alive);
  /// Sends a problem, lets the client read it, and closes. False.
  boost::asio::awaitable<bool> refuse(const Request& request, Response response);
  /// The answer to an upload whose token was revoked, or expired, since it was admitted; nothing while it is valid.
  [[nodiscard]] std::optional<Response> refuse_ended(const Request& request) const;
  /// Why an upload may not even begin; nothing if it may.
  [[nodiscard]] std::optional<Response> refuse_before_upload(const Parser& parser) const;
  [[nodiscard]] Response too_large() const;
  [[nodiscard]] Response too_many_uploads() const;
  /// Writes all bytes of a stretch. False: the client is gone, or the file has fewer.
  boost::asio::awaitable<bool> send_file(const FileStretch& stretch);
  /// Writes all of `text`. The deadline is for progress: a slow reader is no fault, one that takes nothing is.
  boost::asio::awaitable<bool> write_text(std::string_view text);
  [[nodiscard]] const Budgets& budgets() const { return shared_.options.budgets; }
  /// Reads on for a moment after an early answer, so that the client sees it before the connection resets.
  boost::asio::awaitable<void> linger();
  void log(const Request& request, const Response& response);

  ClientStream stream_;
  boost::beast::flat_buffer buffer_;
  ConnectionShared& shared_;
  std::string address_;  ///< of whoever connected
  std::string client_;   ///< the client of the present request: another address than the peer's behind a listed proxy
  std::vector<std::byte> chunk_;
  std::string route_;
  std::uint64_t bytes_in_ = 0;
  std::chrono::steady_clock::time_point started_;
  std::chrono::steady_clock::time_point body_started_;
  std::chrono::steady_clock::duration for_client_{};  ///< of the present request: what its client takes or asks for
  bool keep_alive_ = true;                            ///< the client and the limit of requests allow another one
  bool wants_continue_ = false;
  std::optional<ChunkedBody> chunked_;  ///< of a chunked body
  std::string framing_fault_;
  bool broken_ = false;                      ///< the body ended early; what came before was handed on
  bool folded_ = false;                      ///< a line of the header goes on in the next one
  bool body_unread_ = false;                 ///< bytes of a body may follow, which must not be read as the next request
  std::atomic<std::int64_t> idle_since_{0};  ///< of the steady clock; 0: at work
  std::atomic<bool> leaving_{false};
};

}  // namespace driftlab::server
