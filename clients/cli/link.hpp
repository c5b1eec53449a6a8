#pragma once
/// One connection to a daemon, plain or by TLS, for blocking reads and writes.
#include "core/signal/result.hpp"

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ssl/context.hpp>
#include <boost/asio/ssl/stream.hpp>

#include <optional>
#include <string>

namespace driftlab::cli {

class Link {
 public:
  using executor_type = boost::asio::ip::tcp::socket::executor_type;

  /// `ca_file`: a PEM file of the only authorities to trust; empty: those of the system.
  Link(boost::asio::io_context& io, bool secure, const std::string& ca_file);
  [[nodiscard]] executor_type get_executor() { return socket_.get_executor(); }
  /// Errors: Io, with a sentence that names the address.
  [[nodiscard]] Status connect(const std::string& host, const std::string& port);

  template <class Buffers>
  std::size_t read_some(const Buffers& buffers, boost::system::error_code& error) {
    return tls_ ? tls_->read_some(buffers, error) : socket_.read_some(buffers, error);
  }
  template <class Buffers>
  std::size_t write_some(const Buffers& buffers, boost::system::error_code& error) {
    return tls_ ? tls_->write_some(buffers, error) : socket_.write_some(buffers, error);
  }
  // Beast asks for these too; nothing here calls them.
  template <class Buffers>
  std::size_t read_some(const Buffers& buffers) {
    return tls_ ? tls_->read_some(buffers) : socket_.read_some(buffers);
  }
  template <class Buffers>
  std::size_t write_some(const Buffers& buffers) {
    return tls_ ? tls_->write_some(buffers) : socket_.write_some(buffers);
  }

 private:
  using TlsStream = boost::asio::ssl::stream<boost::asio::ip::tcp::socket&>;
  [[nodiscard]] Status shake_hands(TlsStream& stream, const std::string& host, const std::string& address);

  boost::asio::ssl::context context_{boost::asio::ssl::context::tls_client};
  boost::asio::ip::tcp::socket socket_;
  std::optional<TlsStream> tls_;
  std::string ca_file_;
};

}  // namespace driftlab::cli
