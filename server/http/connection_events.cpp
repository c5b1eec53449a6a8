#include "server/http/connection.hpp"

namespace driftlab::server {

namespace asio = boost::asio;
using namespace std::chrono_literals;

asio::awaitable<bool> HttpConnection::answer_events(const EventHandler& handler, const Request& request) {
  auto begin = [&handler, &request] {
    const ActingFor acting(request.caller);
    return handler(request);
  };
  auto begun = co_await shared_.handlers.run(begin);
  auto settled = settle(std::move(begun));
  if (!settled) {
    co_return co_await send(request, std::move(settled.error()), true);
  }
  const std::unique_ptr<EventSource> source = std::move(*settled);
  const auto executor = co_await asio::this_coro::executor;
  const auto listener = shared_.bell.listen(source->subject(), executor);
  std::string text =
      "HTTP/1.1 200 OK\r\nContent-Type: text/event-stream\r\nCache-Control: no-cache\r\nX-Accel-Buffering: no\r\n"
      "X-Content-Type-Options: nosniff\r\nConnection: close\r\nX-Request-Id: " +
      request.request_id + "\r\n\r\nretry: 3000\n\n";
  auto last_sent = std::chrono::steady_clock::now();
  bool last = request.method == "HEAD";
  while (true) {
    if (!last) {
      auto look = [&source, &request] {
        const ActingFor acting(request.caller);
        return source->next();
      };
      auto batch = co_await shared_.handlers.run(look);
      if (batch && *batch) {
        text += (*batch)->text;
        last = (*batch)->last;
      }
    }
    if (text.empty() && std::chrono::steady_clock::now() - last_sent > 15s) {
      text = ": still here\n\n";
    }
    if (!text.empty()) {
      const bool written = co_await write_text(text);
      if (!written) {
        break;
      }
      last_sent = std::chrono::steady_clock::now();
      text.clear();
    }
    if (last || shared_.stopping || !still_admitted(request)) {
      break;
    }
    co_await listener->wait(1s);
  }
  const Response summary;
  log(request, summary);
  co_return false;
}

}  // namespace driftlab::server
