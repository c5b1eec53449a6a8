#include "server/webhooks/post.hpp"

#include <boost/asio/connect.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ssl/context.hpp>
#include <boost/asio/ssl/host_name_verification.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/ssl/ssl_stream.hpp>

#include <functional>

namespace driftlab::server {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = boost::beast::http;
using asio::ip::tcp;

namespace {

constexpr std::uint32_t kMostAnswerBytes = 65'536;

/// One exchange on an event loop of its own, each step waited for until the common deadline.
class Exchange {
 public:
  Exchange(const DestinationGuard& guard, const Destination& destination, std::chrono::steady_clock::duration patience,
           const std::stop_token& stop)
      : guard_(guard),
        to_(destination),
        until_(std::chrono::steady_clock::now() + patience),
        stop_(stop),
        interrupt_(stop, [this] { loop_.stop(); }) {}

  PostAnswer run(const http::request<http::string_body>& request) {
    PostAnswer answer;
    auto address = resolve();
    if (!address) {
      answer.error = std::move(address.error());
      return answer;
    }
    beast::tcp_stream stream(loop_);
    stream.expires_at(until_);
    const auto connected = wait([&](auto done) { stream.async_connect(*address, done); });
    if (connected) {
      answer.error = sentence("could not be reached", connected);
      return answer;
    }
    return to_.secure ? talk_safely(std::move(stream), request) : talk(stream, request);
  }

 private:
  /// Runs one operation to its end.
  template <class Begin>
  boost::system::error_code wait(Begin begin) {
    boost::system::error_code outcome = asio::error::operation_aborted;
    loop_.restart();
    if (!stop_.stop_requested()) {
      begin([&outcome](const boost::system::error_code& error, auto&&...) { outcome = error; });
      loop_.run();
    }
    return outcome;
  }

  [[nodiscard]] std::string sentence(const std::string& what, const boost::system::error_code& error) const {
    const bool late = error == beast::error::timeout || error == asio::error::timed_out;
    return to_.authority() + " " + what + ": " + (late ? "it took too long" : error.message()) + ".";
  }

  tl::expected<tcp::endpoint, std::string> resolve() {
    tcp::resolver resolver(loop_);
    tcp::resolver::results_type found;
    boost::system::error_code outcome = asio::error::timed_out;
    resolver.async_resolve(to_.host, std::to_string(to_.port), tcp::resolver::numeric_service,
                           [&](const boost::system::error_code& error, tcp::resolver::results_type results) {
                             outcome = error;
                             found = std::move(results);
                           });
    loop_.run_until(until_);
    resolver.cancel();
    if (outcome) {
      return tl::unexpected(sentence("has no address", outcome));
    }
    for (const auto& entry : found) {
      if (guard_.admits(to_.host, entry.endpoint().address())) {
        return entry.endpoint();
      }
    }
    return tl::unexpected(to_.host +
                          " leads to no address of the Internet; the operator allows it by --webhook-allow.");
  }

  PostAnswer talk_safely(beast::tcp_stream plain, const http::request<http::string_body>& request) {
    PostAnswer answer;
    asio::ssl::context tls(asio::ssl::context::tls_client);
    boost::system::error_code ignored;
    ignored = tls.set_default_verify_paths(ignored);
    SSL_CTX_set_min_proto_version(tls.native_handle(), TLS1_2_VERSION);
    beast::ssl_stream<beast::tcp_stream> stream(std::move(plain), tls);
    stream.set_verify_mode(asio::ssl::verify_peer);
    stream.set_verify_callback(asio::ssl::host_name_verification(to_.host));
    boost::system::error_code literal;
    (void)asio::ip::make_address(to_.host, literal);
    if (literal) {  // addresses have no server name (RFC 6066)
      SSL_set_tlsext_host_name(stream.native_handle(), to_.host.c_str());
    }
    const auto shaken = wait([&](auto done) { stream.async_handshake(asio::ssl::stream_base::client, done); });
    if (shaken) {
      const long verdict = SSL_get_verify_result(stream.native_handle());
      answer.error = verdict == X509_V_OK ? sentence("speaks no TLS that could be agreed on", shaken)
                                          : "The certificate of " + to_.authority() +
                                                " is not trusted: " + X509_verify_cert_error_string(verdict) + ".";
      return answer;
    }
    return talk(stream, request);
  }

  template <class Stream>
  PostAnswer talk(Stream& stream, const http::request<http::string_body>& request) {
    PostAnswer answer;
    const auto sent = wait([&](auto done) { http::async_write(stream, request, done); });
    beast::flat_buffer buffer(kMostAnswerBytes);
    http::response_parser<http::empty_body> parser;
    parser.header_limit(kMostAnswerBytes);
    // A receiver may answer before it has read everything, and close.
    const auto read = wait([&](auto done) { http::async_read_header(stream, buffer, parser, done); });
    if (!parser.is_header_done()) {
      answer.error = sentence("did not answer", sent ? sent : read);
      return answer;
    }
    answer.status = static_cast<int>(parser.get().result_int());
    const auto pause = parser.get()[http::field::retry_after];
    answer.retry_after.assign(pause.data(), pause.size());
    return answer;
  }

  const DestinationGuard& guard_;
  const Destination& to_;
  const std::chrono::steady_clock::time_point until_;
  const std::stop_token stop_;
  asio::io_context loop_;
  std::stop_callback<std::function<void()>> interrupt_;
};

}  // namespace

PostAnswer post(const DestinationGuard& guard, const Destination& destination,
                const std::vector<std::pair<std::string, std::string>>& headers, const std::string& body,
                std::chrono::steady_clock::duration patience, const std::stop_token& stop) {
  http::request<http::string_body> request(http::verb::post, destination.target, 11);
  request.set(http::field::host, destination.authority());
  request.set(http::field::user_agent, "driftlab/" DRIFTLAB_VERSION);
  request.set(http::field::content_type, "application/json");
  for (const auto& [name, value] : headers) {
    request.set(name, value);
  }
  request.keep_alive(false);
  request.body() = body;
  request.prepare_payload();
  try {
    return Exchange(guard, destination, patience, stop).run(request);
  } catch (const std::exception& unforeseen) {
    return {0, "", destination.authority() + " could not be asked: " + unforeseen.what() + "."};
  }
}

}  // namespace driftlab::server
