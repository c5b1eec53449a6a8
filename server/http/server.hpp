#pragma once
/// The HTTP server: Boost.Beast on Asio coroutines. One strand per connection; I/O threads never block: handlers,
/// uploads and event sources run on bounded pools.
///
/// Limits and deadlines are the budgets of connections, documents and uploads (server/store/budgets.hpp). A connection
/// waits for a place no longer than others idle: when every place is taken, the one that has said nothing for longest
/// is closed. After any protocol error, and after a body that was not read, the connection closes.
#include "server/http/bell.hpp"
#include "server/http/certificate.hpp"
#include "server/http/guard.hpp"
#include "server/http/router.hpp"
#include "server/store/budgets.hpp"
#include "server/store/network.hpp"

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace driftlab::server {

struct HttpOptions {
  std::string address = "127.0.0.1";
  std::uint16_t port = 8477;
  int io_threads = 2;
  int handler_threads = 4;
  int slow_threads = 2;  ///< for handlers that read a whole recording
  int upload_threads = 2;
  Budgets budgets;
  std::vector<Network> proxies;  ///< exempt from the budgets of one address, as loopback is; their Forwarded counts
  GuardLimits guard;
  std::shared_ptr<boost::asio::ssl::context> tls;  ///< the certificate to show; nullptr: plain HTTP
};

/// One finished request, for the access log.
struct AccessRecord {
  std::string method;
  std::string route;  ///< template, or empty where none matched
  std::string target;
  int status = 0;
  std::uint64_t bytes_in = 0;
  std::uint64_t bytes_out = 0;
  double seconds = 0.0;         ///< from the header to the end of the answer
  double client_seconds = 0.0;  ///< of these: waiting for its body, or for what it asked to wait for; a stream goes on
  std::string request_id;
  std::string address;
  std::string token;                            ///< public id; empty if no token was required
  std::optional<Error> failure = std::nullopt;  ///< of the daemon itself
};

/// What the server needs from the daemon.
struct HttpHooks {
  /// Says who asks, in `request.caller`, or why the request is not admitted. Stands before every answer that a route or
  /// a page (no route) gives. May be empty: everybody is admitted. Called from I/O threads; must not block.
  std::function<std::optional<Response>(const Route* route, Request& request)> admit;
  /// Whether whoever was admitted would be still, for answers that go on for long. May be empty.
  std::function<bool(const Principal&)> still_admitted;
  /// Runs a plain route on a pool thread: checks, handler, ETag, idempotency.
  std::function<Response(const Route&, const Request&)> dispatch;
  /// The answer of a plain route, where it is known without running it. May be empty. Called from I/O threads; must not
  /// block.
  std::function<std::optional<Response>(const Route&, const Request&)> known;
  /// Pages and files for people, which are no part of the API. May be empty. Called from I/O threads; must not block.
  std::function<std::optional<Response>(const Request&)> page;
  /// Adds request id and instance to a problem document.
  std::function<void(const Request&, Response&)> complete;
  /// A fresh request id.
  std::function<std::string()> make_request_id;
  /// May be empty. Called from I/O threads; must not block.
  std::function<void(const AccessRecord&)> log;
};

class HttpServer {
 public:
  /// `router` and `bell` must outlive the server.
  HttpServer(HttpOptions options, const Router& router, Bell& bell, HttpHooks hooks);
  HttpServer(const HttpServer&) = delete;
  HttpServer& operator=(const HttpServer&) = delete;
  ~HttpServer();

  /// Binds and starts the I/O threads. Errors: Io (address in use, not permitted), InvalidArgument (address).
  [[nodiscard]] Status start();
  /// Shows another certificate to connections from now on; those that are open keep theirs. Thread safe.
  void show(std::shared_ptr<boost::asio::ssl::context> tls);
  /// The port bound, useful when 0 was asked for.
  [[nodiscard]] std::uint16_t port() const;
  /// Connections open now, and of these the ones that wait for a request.
  struct Load {
    std::size_t connections = 0;
    std::size_t idle = 0;
    std::size_t uploads = 0;
    std::size_t in_flight = 0;      ///< requests that are being answered
    std::uint64_t turned_away = 0;  ///< connections closed for want of a place, since the start
  };
  [[nodiscard]] Load load() const;
  /// Whether an I/O thread takes up work in that time.
  [[nodiscard]] bool is_alive(std::chrono::milliseconds patience) const;
  /// Stops accepting, lets running requests finish for up to `grace`, closes event streams, joins. Idempotent.
  void stop(std::chrono::milliseconds grace);

 private:
  struct Shared;
  std::unique_ptr<Shared> shared_;
};

}  // namespace driftlab::server
