#pragma once
/// The stream of one connection: TCP, or TLS over it. Both read and write alike, with the deadlines of the TCP stream.
#include <boost/asio/async_result.hpp>
#include <boost/asio/awaitable.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ssl/context.hpp>
#include <boost/asio/ssl/stream.hpp>
#include <boost/beast/core/tcp_stream.hpp>

#include <chrono>
#include <memory>
#include <optional>

namespace driftlab::server {

class ClientStream {
 public:
  using executor_type = boost::beast::tcp_stream::executor_type;

  /// `tls`: the certificate to show; nullptr: plain TCP. It is kept as long as the connection needs it.
  ClientStream(boost::asio::ip::tcp::socket socket, std::shared_ptr<boost::asio::ssl::context> tls)
      : tcp_(std::move(socket)), context_(std::move(tls)) {
    if (context_) {
      tls_.emplace(tcp_, *context_);
    }
  }
  ClientStream(const ClientStream&) = delete;
  ClientStream& operator=(const ClientStream&) = delete;
  ~ClientStream() = default;

  [[nodiscard]] executor_type get_executor() { return tcp_.get_executor(); }
  [[nodiscard]] boost::asio::ip::tcp::socket& socket() { return tcp_.socket(); }
  [[nodiscard]] bool is_tls() const { return tls_.has_value(); }
  /// Bytes that were decrypted and not yet read.
  [[nodiscard]] std::size_t decrypted() {
    return tls_ ? static_cast<std::size_t>(SSL_pending(tls_->native_handle())) : 0;
  }
  /// Reads what `decrypted` says, without waiting.
  template <class Buffers>
  std::size_t read_decrypted(const Buffers& buffers, boost::system::error_code& error) {
    return tls_ ? tls_->read_some(buffers, error) : 0;
  }

  void expires_after(std::chrono::nanoseconds time) { tcp_.expires_after(time); }
  void expires_at(boost::beast::net::steady_timer::time_point time) { tcp_.expires_at(time); }
  void cancel() { tcp_.cancel(); }
  /// The TCP stream below, for what is read only to be thrown away.
  [[nodiscard]] boost::beast::tcp_stream& below() { return tcp_; }

  /// Nothing to do without TLS.
  boost::asio::awaitable<bool> handshake(std::chrono::seconds patience);
  /// Says that no more will come (close_notify), so that the client can tell an end from a cut. Waits a moment at most.
  boost::asio::awaitable<void> say_goodbye();

  template <class Buffers, class Token>
  auto async_read_some(const Buffers& buffers, Token&& token) {
    return boost::asio::async_initiate<Token, void(boost::system::error_code, std::size_t)>(
        [this](auto handler, const Buffers& into) {
          if (tls_) {
            tls_->async_read_some(into, std::move(handler));
          } else {
            tcp_.async_read_some(into, std::move(handler));
          }
        },
        token, buffers);
  }

  template <class Buffers, class Token>
  auto async_write_some(const Buffers& buffers, Token&& token) {
    return boost::asio::async_initiate<Token, void(boost::system::error_code, std::size_t)>(
        [this](auto handler, const Buffers& from) {
          if (tls_) {
            tls_->async_write_some(from, std::move(handler));
          } else {
            tcp_.async_write_some(from, std::move(handler));
          }
        },
        token, buffers);
  }

 private:
  boost::beast::tcp_stream tcp_;
  std::shared_ptr<boost::asio::ssl::context> context_;
  std::optional<boost::asio::ssl::stream<boost::beast::tcp_stream&>> tls_;
};

}  // namespace driftlab::server
