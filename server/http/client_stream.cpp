#include "server/http/client_stream.hpp"

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
  if (tls_) {
    boost::system::error_code ignored;
    tcp_.expires_after(1s);
    co_await tls_->async_shutdown(asio::redirect_error(asio::use_awaitable, ignored));
  }
}

}  // namespace driftlab::server
