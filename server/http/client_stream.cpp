#include "server/http/client_stream.hpp"

#include <boost/asio/as_tuple.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/use_awaitable.hpp>

namespace driftlab::server {

namespace asio = boost::asio;
using namespace std::chrono_literals;

asio::awaitable<bool> ClientStream::handshake(std::chrono::seconds patience) {
  if (!tls_) {
    co_return true;
  }
  boost::system::error_code error;
  tcp_.expires_after(patience);
  co_await tls_->async_handshake(asio::ssl::stream_base::server, asio::redirect_error(asio::use_awaitable, error));
  co_return !error;
}

asio::awaitable<void> ClientStream::say_goodbye() {
#ifndef __clang_analyzer__  // it takes the context of Boost.Asio's coroutine, set before the frame runs, for unset
  if (tls_) {
    tcp_.expires_after(1s);
    (void)co_await tls_->async_shutdown(asio::as_tuple(asio::use_awaitable));
  }
#endif
  co_return;
}

}  // namespace driftlab::server
