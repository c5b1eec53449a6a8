#include "server/http/server.hpp"

#include <boost/asio/connect.hpp>
#include <boost/asio/read_until.hpp>
#include <boost/asio/streambuf.hpp>
#include <boost/asio/write.hpp>
#include <gtest/gtest.h>
#include <sys/socket.h>

#include <future>
#include <istream>

namespace driftlab::server {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;

/// A client whose reads fail after ten seconds.
class Client {
 public:
  explicit Client(std::uint16_t port) : socket_(io_) {
    socket_.connect({asio::ip::make_address("127.0.0.1"), port});
    const timeval patience{10, 0};
    ::setsockopt(socket_.native_handle(), SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
  }
  void ask(const std::string& path) {
    asio::write(socket_, asio::buffer("GET " + path + " HTTP/1.1\r\nHost: localhost\r\n\r\n"));
  }
  /// The status line; empty where no answer comes.
  std::string answer() {
    asio::streambuf buffer;
    boost::system::error_code error;
    asio::read_until(socket_, buffer, "\r\n", error);
    std::istream stream(&buffer);
    std::string line;
    std::getline(stream, line);
    return error ? "" : line;
  }

 private:
  asio::io_context io_;
  tcp::socket socket_;
};

TEST(HttpServer, AnswersAnInstantRouteWhileEveryHandlerThreadIsBusy) {
  std::promise<void> entered;
  std::promise<void> leave;
  Router router;
  router.add({"GET", "/slow", "slow", {}, Handler([&](const Request&) -> Result<Response> {
                entered.set_value();
                leave.get_future().wait();
                return Response{};
              })});
  Route health{"GET", "/alive", "alive", {}, Handler([](const Request&) -> Result<Response> { return Response{}; })};
  health.lane = Lane::Instant;
  router.add(std::move(health));
  HttpOptions options;
  options.port = 0;
  options.handler_threads = 1;
  options.guard.hosts = {"localhost"};
  Bell bell;
  HttpHooks hooks;
  hooks.dispatch = [](const Route& route, const Request& request) {
    return std::get<Handler>(route.handler)(request).value_or(Response{});
  };
  hooks.complete = [](const Request&, Response&) {};
  hooks.make_request_id = [] { return std::string("req"); };
  HttpServer server(options, router, bell, hooks);
  ASSERT_TRUE(server.start());
  Client busy(server.port());
  busy.ask("/slow");
  entered.get_future().wait();
  Client probe(server.port());
  probe.ask("/alive");
  EXPECT_EQ(probe.answer(), "HTTP/1.1 200 OK\r");
  leave.set_value();
  EXPECT_EQ(busy.answer(), "HTTP/1.1 200 OK\r");
  server.stop(std::chrono::milliseconds(0));
}

}  // namespace
}  // namespace driftlab::server
