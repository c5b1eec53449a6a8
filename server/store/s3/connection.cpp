#include "server/store/s3/connection.hpp"

#include "core/signal/text.hpp"

#include <boost/asio/connect.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ssl/context.hpp>
#include <boost/asio/ssl/host_name_verification.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/ssl/ssl_stream.hpp>

#include <array>
#include <type_traits>

namespace driftlab::server::s3 {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = boost::beast::http;
using asio::ip::tcp;

namespace {

constexpr std::uint32_t kMostHeaderBytes = 65'536;
constexpr std::uint64_t kMostTextBytes = 16ULL << 20U;
constexpr std::size_t kPieceBytes = 1U << 18U;

tl::unexpected<Error> broken(const std::string& what, const boost::system::error_code& error) {
  const bool late = error == beast::error::timeout || error == asio::error::timed_out;
  const bool cut = error == http::error::end_of_stream || error == http::error::partial_message ||
                   error == asio::error::eof || error == asio::ssl::error::stream_truncated;
  return fail(ErrorCode::Io, what + ": " +
                                 (late  ? "it took too long"
                                  : cut ? "the connection was cut"
                                        : error.message()) +
                                 ".");
}

/// On an event loop of its own, each step waited for.
template <class Stream>
class OpenConnection final : public Connection {
 public:
  template <class... Arguments>
  OpenConnection(const Place& place, const Patience& patience, Arguments&&... arguments)
      : place_(place), patience_(patience), stream_(loop_, std::forward<Arguments>(arguments)...) {}
  OpenConnection(const OpenConnection&) = delete;
  OpenConnection& operator=(const OpenConnection&) = delete;
  ~OpenConnection() override = default;

  Status connect() {
    tcp::resolver resolver(loop_);
    tcp::resolver::results_type found;
    boost::system::error_code outcome = asio::error::timed_out;
    resolver.async_resolve(place_.host, std::to_string(place_.port), tcp::resolver::numeric_service,
                           [&](const boost::system::error_code& error, tcp::resolver::results_type results) {
                             outcome = error;
                             found = std::move(results);
                           });
    loop_.run_for(patience_.connecting);
    resolver.cancel();
    if (outcome) {
      return broken("has no address", outcome);
    }
    plain().expires_after(patience_.connecting);
    if (const auto error = wait([&](auto done) { plain().async_connect(found, done); })) {
      return broken("could not be reached", error);
    }
    boost::system::error_code ignored;
    ignored = plain().socket().set_option(tcp::no_delay(true), ignored);
    if constexpr (!std::is_same_v<Stream, beast::tcp_stream>) {
      return shake_hands();
    }
    open_ = true;
    return {};
  }

  [[nodiscard]] Result<Reply> exchange(const Request& request, const Sink& sink) override {
    open_ = false;
    http::request<http::span_body<const std::byte>> message;
    message.version(11);
    message.method_string(request.verb);
    message.target(request.target);
    for (const auto& [name, value] : request.headers) {
      message.set(name, value);
    }
    message.set(http::field::user_agent, "driftlab/" DRIFTLAB_VERSION);
    message.body() = beast::span<const std::byte>(request.body.data(), request.body.size());
    if (!request.body.empty() || request.verb == "PUT" || request.verb == "POST") {
      message.content_length(request.body.size());
    }
    plain().expires_after(time_for(request.body.size()));
    // A server may answer before it has read everything, and close.
    const auto sent = wait([&](auto done) { http::async_write(stream_, message, done); });
    http::response_parser<http::buffer_body> parser;
    parser.header_limit(kMostHeaderBytes);
    parser.body_limit(boost::none);
    parser.skip(request.verb == "HEAD");
    beast::flat_buffer buffer(kPieceBytes + kMostHeaderBytes);
    plain().expires_after(sent ? patience_.moving : patience_.answering);
    const auto read = wait([&](auto done) { http::async_read_header(stream_, buffer, parser, done); });
    if (!parser.is_header_done()) {
      return broken("did not answer", sent ? sent : read);
    }
    Reply reply;
    reply.status = static_cast<int>(parser.get().result_int());
    for (const auto& field : parser.get().base()) {
      const std::string name = lower_case(std::string_view(field.name_string().data(), field.name_string().size()));
      reply.headers[name] = std::string(field.value().data(), field.value().size());
    }
    if (Status taken = read_body(parser, buffer, reply, reply.status / 100 == 2 ? sink : Sink()); !taken) {
      return fail(taken.error());
    }
    open_ = !sent && parser.keep_alive();
    return reply;
  }

  [[nodiscard]] bool is_open() const override { return open_; }

 private:
  beast::tcp_stream& plain() { return beast::get_lowest_layer(stream_); }

  /// Runs one operation to its end.
  template <class Begin>
  boost::system::error_code wait(Begin begin) {
    boost::system::error_code outcome = asio::error::operation_aborted;
    loop_.restart();
    begin([&outcome](const boost::system::error_code& error, auto&&...) { outcome = error; });
    loop_.run();
    return outcome;
  }

  [[nodiscard]] std::chrono::milliseconds time_for(std::uint64_t bytes) const {
    return patience_.moving + std::chrono::milliseconds(bytes * 1000 / patience_.bytes_per_second);
  }

  Status shake_hands() {
    if constexpr (!std::is_same_v<Stream, beast::tcp_stream>) {
      stream_.set_verify_mode(asio::ssl::verify_peer);
      stream_.set_verify_callback(asio::ssl::host_name_verification(place_.host));
      boost::system::error_code literal;
      (void)asio::ip::make_address(place_.host, literal);
      if (literal) {  // addresses have no server name (RFC 6066)
        SSL_set_tlsext_host_name(stream_.native_handle(), place_.host.c_str());
      }
      if (const auto error = wait([&](auto done) { stream_.async_handshake(asio::ssl::stream_base::client, done); })) {
        const long verdict = SSL_get_verify_result(stream_.native_handle());
        return verdict == X509_V_OK ? Status(broken("speaks no TLS that could be agreed on", error))
                                    : fail(ErrorCode::Io, std::string("has a certificate that is not trusted: ") +
                                                              X509_verify_cert_error_string(verdict) + ".");
      }
    }
    open_ = true;
    return {};
  }

  template <class Parser>
  Status read_body(Parser& parser, beast::flat_buffer& buffer, Reply& reply, const Sink& sink) {
    std::vector<std::byte> piece(kPieceBytes);
    plain().expires_after(time_for(parser.content_length().value_or(kMostTextBytes)));
    while (!parser.is_done()) {
      parser.get().body().data = piece.data();
      parser.get().body().size = piece.size();
      auto error = wait([&](auto done) { http::async_read_some(stream_, buffer, parser, done); });
      if (error == http::error::need_buffer) {
        error = {};
      }
      const std::span<const std::byte> got(piece.data(), piece.size() - parser.get().body().size);
      if (sink) {
        if (Status taken = got.empty() ? Status{} : sink(got); !taken) {
          return taken;
        }
      } else if (reply.body.size() + got.size() <= kMostTextBytes) {
        reply.body.append(reinterpret_cast<const char*>(got.data()), got.size());
      } else {
        return fail(ErrorCode::Io, "answers at too great a length.");
      }
      if (error) {
        return broken("broke off in its answer", error);
      }
    }
    return {};
  }

  const Place& place_;
  const Patience& patience_;
  asio::io_context loop_;
  Stream stream_;
  bool open_ = false;
};

template <class Stream, class... Arguments>
Result<std::unique_ptr<Connection>> open(const Place& place, const Patience& patience, Arguments&&... arguments) {
  auto connection = std::make_unique<OpenConnection<Stream>>(place, patience, std::forward<Arguments>(arguments)...);
  if (Status connected = connection->connect(); !connected) {
    return fail(connected.error());
  }
  return connection;
}

}  // namespace

Connection::Connection() = default;
Connection::~Connection() = default;

struct Connector::Trust {
  asio::ssl::context tls{asio::ssl::context::tls_client};
};

Connector::Connector(Place place, Patience patience)
    : place_(std::move(place)), patience_(patience), trust_(std::make_unique<Trust>()) {
  if (place_.secure) {
    boost::system::error_code ignored;
    ignored = trust_->tls.set_default_verify_paths(ignored);
    SSL_CTX_set_min_proto_version(trust_->tls.native_handle(), TLS1_2_VERSION);
  }
}

Connector::~Connector() = default;

Result<std::unique_ptr<Connection>> Connector::connect() const {
  try {
    return place_.secure ? open<beast::ssl_stream<beast::tcp_stream>>(place_, patience_, trust_->tls)
                         : open<beast::tcp_stream>(place_, patience_);
  } catch (const std::exception& unforeseen) {
    return fail(ErrorCode::Io, std::string("could not be asked: ") + unforeseen.what() + ".");
  }
}

}  // namespace driftlab::server::s3
