#include "server/http/bell.hpp"

#include <boost/asio/post.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/use_awaitable.hpp>

namespace driftlab::server {

namespace asio = boost::asio;

asio::awaitable<void> Bell::Listener::wait(std::chrono::steady_clock::duration longest) {
  if (!rung_) {
    timer_.expires_after(longest);
    boost::system::error_code ignored;
    co_await timer_.async_wait(asio::redirect_error(asio::use_awaitable, ignored));
  }
  rung_ = false;
}

void Bell::Listener::notify() {
  asio::post(timer_.get_executor(), [self = shared_from_this()] {
    self->rung_ = true;
    self->timer_.cancel();
  });
}

std::shared_ptr<Bell::Listener> Bell::listen(const std::string& subject, const asio::any_io_executor& executor) {
  auto listener = std::make_shared<Listener>(executor);
  const std::lock_guard lock(mutex_);
  std::erase_if(listeners_, [](const auto& entry) { return entry.second.expired(); });
  listeners_.emplace(subject, listener);
  return listener;
}

void Bell::ring(const std::string& subject) {
  const std::lock_guard lock(mutex_);
  const auto [first, last] = listeners_.equal_range(subject);
  for (auto entry = first; entry != last; ++entry) {
    if (const auto listener = entry->second.lock()) {
      listener->notify();
    }
  }
}

void Bell::ring_all() {
  const std::lock_guard lock(mutex_);
  for (const auto& [subject, weak] : listeners_) {
    if (const auto listener = weak.lock()) {
      listener->notify();
    }
  }
}

}  // namespace driftlab::server
