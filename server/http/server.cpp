#include "server/http/server.hpp"

#include "server/http/connection.hpp"
#include "server/http/forwarded.hpp"

#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/asio/strand.hpp>

#include <algorithm>
#include <condition_variable>
#include <future>
#include <list>
#include <map>
#include <mutex>
#include <thread>

namespace driftlab::server {

namespace asio = boost::asio;
using asio::ip::tcp;

struct HttpServer::Shared {
  Shared(HttpOptions given, const Router& router, Bell& bell_in, HttpHooks given_hooks)
      : options(std::move(given)),
        hooks(std::move(given_hooks)),
        bell(bell_in),
        handlers(static_cast<std::size_t>(options.handler_threads),
                 static_cast<std::size_t>(options.budgets.requests_waiting)),
        slow(static_cast<std::size_t>(options.slow_threads),
             static_cast<std::size_t>(options.budgets.requests_waiting)),
        uploads(static_cast<std::size_t>(options.upload_threads), 1024),
        decodings(static_cast<std::size_t>(options.budgets.decodings), 1024),
        connection_shared{options, router,    bell_in,  hooks,         handlers, slow,
                          uploads, decodings, stopping, upload_places, in_flight},
        work(asio::make_work_guard(io)),
        acceptor(io) {}

  asio::awaitable<void> accept();
  asio::awaitable<void> serve(tcp::socket socket, std::string address);
  void close_idle_connections();
  /// Counts a connection of this address in, at the cost of an idle one where there is no place. False: everybody is at
  /// work.
  [[nodiscard]] bool admit(const std::string& address);
  /// Closes the connection that has waited longest, of `address` or of anybody. `mutex` is held.
  bool close_longest_idle(const std::string* address);
  [[nodiscard]] bool is_exempt(const std::string& address) const;

  HttpOptions options;
  HttpHooks hooks;
  Bell& bell;
  std::atomic<bool> stopping{false};
  UploadPlaces upload_places{options.budgets, [this](const std::string& address) { return is_exempt(address); }};
  RequestsInFlight in_flight{options.budgets.requests_per_token};
  BoundedPool handlers;
  BoundedPool slow;
  BoundedPool uploads;
  BoundedPool decodings;
  ConnectionShared connection_shared;
  asio::io_context io;
  asio::executor_work_guard<asio::io_context::executor_type> work;
  tcp::acceptor acceptor;
  std::vector<std::thread> threads;
  std::mutex mutex;
  std::condition_variable idle;
  std::map<std::string, std::size_t> per_address;
  std::list<std::weak_ptr<HttpConnection>> connections;
  std::size_t open = 0;
  std::size_t leaving = 0;  ///< of these, told to close for want of a place
  std::uint64_t turned_away = 0;
};

bool HttpServer::Shared::is_exempt(const std::string& address) const {
  boost::system::error_code error;
  const auto parsed = asio::ip::make_address(address, error);
  return !error && (parsed.is_loopback() || is_listed(address, options.proxies));
}

bool HttpServer::Shared::close_longest_idle(const std::string* address) {
  std::shared_ptr<HttpConnection> longest;
  std::optional<std::chrono::steady_clock::time_point> since;  // the longest one waits
  for (const auto& entry : connections) {
    auto connection = entry.lock();
    if (!connection || (address != nullptr && connection->address() != *address)) {
      continue;
    }
    const auto silent = connection->idle_since();
    if (silent && (!since || *silent < *since)) {
      longest = std::move(connection);
      since = silent;
    }
  }
  if (!longest) {
    return false;
  }
  longest->leave();
  ++leaving;
  ++turned_away;
  const auto executor = longest->executor();
  asio::post(executor, [longest = std::move(longest)] { longest->close_if_idle(); });
  return true;
}

bool HttpServer::Shared::admit(const std::string& address) {
  const std::lock_guard lock(mutex);
  const auto most = static_cast<std::size_t>(options.budgets.connections);
  const auto most_of_one = static_cast<std::size_t>(options.budgets.connections_per_address);
  const bool crowded = !is_exempt(address) && per_address[address] >= most_of_one;
  // Those that leave are still counted; beyond twice the budget they leave too slowly.
  if ((crowded && (per_address[address] >= 2 * most_of_one || !close_longest_idle(&address))) ||
      (open - leaving >= most && (open >= 2 * most || !close_longest_idle(nullptr)))) {
    ++turned_away;
    return false;
  }
  ++open;
  ++per_address[address];
  return true;
}

asio::awaitable<void> HttpServer::Shared::serve(tcp::socket socket, std::string address) {
  std::shared_ptr<HttpConnection> connection;
  {
    const std::lock_guard lock(mutex);
    connection = std::make_shared<HttpConnection>(std::move(socket), options.tls, connection_shared);
    std::erase_if(connections, [](const auto& entry) { return entry.expired(); });
    connections.push_back(connection);
  }
  try {
    co_await connection->run();
  } catch (const std::exception&) {
    connection->abandon();  // A connection that fails in an unforeseen way closes; the daemon goes on.
  }
  const bool left = connection && connection->is_leaving();
  connection.reset();
  const std::lock_guard lock(mutex);
  --open;
  leaving -= left ? 1 : 0;
  if (--per_address[address] == 0) {
    per_address.erase(address);
  }
  idle.notify_all();
}

void HttpServer::Shared::close_idle_connections() {
  const std::lock_guard lock(mutex);
  for (const auto& entry : connections) {
    if (auto connection = entry.lock()) {
      const auto executor = connection->executor();
      asio::post(executor, [connection = std::move(connection)] { connection->close_if_idle(); });
    }
  }
}

asio::awaitable<void> HttpServer::Shared::accept() {
  while (!stopping) {
    boost::system::error_code error;
    tcp::socket socket(asio::make_strand(io));
    co_await acceptor.async_accept(socket, asio::redirect_error(asio::use_awaitable, error));
    if (error == asio::error::operation_aborted) {
      co_return;
    }
    if (error) {
      // Out of descriptors, or the client left before it was accepted: wait a moment and go on.
      asio::steady_timer pause(io, std::chrono::milliseconds(20));
      co_await pause.async_wait(asio::redirect_error(asio::use_awaitable, error));
      continue;
    }
    const auto peer = socket.remote_endpoint(error);
    const std::string address = error ? std::string() : plain_text(peer.address());
    if (!admit(address)) {
      continue;  // closes the socket
    }
    error = socket.set_option(tcp::no_delay(true), error);
    const auto held = static_cast<int>(options.budgets.send_buffer_bytes);
    error = socket.set_option(asio::socket_base::send_buffer_size(held), error);
    const auto strand = socket.get_executor();
    asio::co_spawn(strand, serve(std::move(socket), address), asio::detached);
  }
}

HttpServer::HttpServer(HttpOptions options, const Router& router, Bell& bell, HttpHooks hooks)
    : shared_(std::make_unique<Shared>(std::move(options), router, bell, std::move(hooks))) {}

HttpServer::~HttpServer() { stop(std::chrono::milliseconds(0)); }

Status HttpServer::start() {
  boost::system::error_code error;
  const auto address = asio::ip::make_address(shared_->options.address, error);
  if (error) {
    return fail(ErrorCode::InvalidArgument, "The address '" + shared_->options.address + "' is not an IP address.",
                {{"parameter", "listen"}});
  }
  const tcp::endpoint endpoint(address, shared_->options.port);
  tcp::acceptor& acceptor = shared_->acceptor;
  error = acceptor.open(endpoint.protocol(), error);
  if (!error) {
    error = acceptor.set_option(asio::socket_base::reuse_address(true), error);
    error = acceptor.bind(endpoint, error);
  }
  if (!error) {
    error = acceptor.listen(asio::socket_base::max_listen_connections, error);
  }
  if (error) {
    return fail(ErrorCode::Io,
                "Cannot listen on " + shared_->options.address + ":" + std::to_string(shared_->options.port) + ": " +
                    error.message() + ".",
                {{"parameter", "listen"}});
  }
  asio::co_spawn(shared_->io, shared_->accept(), asio::detached);
  for (int i = 0; i < shared_->options.io_threads; ++i) {
    shared_->threads.emplace_back([this] { shared_->io.run(); });
  }
  return {};
}

void HttpServer::show(std::shared_ptr<asio::ssl::context> tls) {
  const std::lock_guard lock(shared_->mutex);
  shared_->options.tls = std::move(tls);
}

std::uint16_t HttpServer::port() const {
  boost::system::error_code error;
  return shared_->acceptor.local_endpoint(error).port();
}

HttpServer::Load HttpServer::load() const {
  const std::lock_guard lock(shared_->mutex);
  Load load;
  load.connections = shared_->open;
  load.turned_away = shared_->turned_away;
  load.uploads = shared_->upload_places.taken();
  load.in_flight = static_cast<std::size_t>(shared_->in_flight.count());
  for (const auto& entry : shared_->connections) {
    const auto connection = entry.lock();
    load.idle += connection && connection->idle_since() ? 1 : 0;
  }
  return load;
}

bool HttpServer::is_alive(std::chrono::milliseconds patience) const {
  const auto turned = std::make_shared<std::promise<void>>();
  auto turn = turned->get_future();
  asio::post(shared_->io, [turned] { turned->set_value(); });
  return turn.wait_for(patience) == std::future_status::ready;
}

void HttpServer::stop(std::chrono::milliseconds grace) {
  if (shared_->threads.empty()) {
    return;
  }
  shared_->stopping = true;
  asio::post(shared_->io, [this] {
    boost::system::error_code ignored;
    ignored = shared_->acceptor.close(ignored);
  });
  shared_->bell.ring_all();
  shared_->close_idle_connections();
  {
    std::unique_lock lock(shared_->mutex);
    shared_->idle.wait_for(lock, grace, [&] { return shared_->open == 0; });
  }
  shared_->work.reset();
  shared_->io.stop();
  for (std::thread& thread : shared_->threads) {
    thread.join();
  }
  shared_->threads.clear();
  shared_->handlers.join();
  shared_->slow.join();
  shared_->uploads.join();
  shared_->decodings.join();
}

}  // namespace driftlab::server
