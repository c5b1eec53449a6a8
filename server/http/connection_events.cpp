// Answers that go on: events as they come, until the client, the job or the daemon has enough.
#include "server/http/answer_head.hpp"
#include "server/http/connection.hpp"

namespace driftlab::server {

namespace asio = boost::asio;
using namespace std::chrono_literals;

asio::awaitable<bool> HttpConnection::write_text(std::string_view text) {
  while (!text.empty()) {
    boost::system::error_code error;
    stream_.expires_after(std::chrono::seconds(budgets().write_stall_seconds));
    text.remove_prefix(co_await stream_.async_write_some(asio::buffer(text), into(error)));
    if (error) {
      co_return false;
    }
  }
  co_return true;
}

asio::awaitable<bool> HttpConnection::answer_events(const EventHandler& handler, const Request& request) {
  auto begin = [&handler, &request] {
    const ActingFor acting(request.caller);
    return handler(request);
  };
  auto begun = co_await shared_.handlers.run(begin);
  auto settled = settle(std::move(begun), budgets());
  if (!settled) {
    co_return co_await send(request, std::move(settled.error()), true);
  }
  const std::unique_ptr<EventSource> source = std::move(*settled);
  const auto executor = co_await asio::this_coro::executor;
  const auto listener = shared_.bell.listen(source->subject(), executor);
  Response stream;
  stream.content_type = "text/event-stream";
  stream.headers = {{"X-Accel-Buffering", "no"}};
  std::string text = answer_head(stream, {request.request_id, std::nullopt, true});
  if (request.method != "HEAD") {
    text += "retry: 3000\n\n";
  }
  auto last_sent = std::chrono::steady_clock::now();
  bool last = request.method == "HEAD";
  std::optional<Timed> streamed;  // what went before its first byte is the daemon's time
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
      if (!streamed) {
        streamed.emplace(for_client_);
      }
    }
    if (last || shared_.stopping || !still_admitted(request)) {
      break;
    }
    co_await listener->wait(1s);
  }
  streamed.reset();
  const Response summary;
  log(request, summary);
  co_return false;
}

}  // namespace driftlab::server
