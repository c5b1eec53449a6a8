#include "clients/cli/link.hpp"

#include <boost/asio/connect.hpp>
#include <boost/asio/ssl/host_name_verification.hpp>

namespace driftlab::cli {

namespace asio = boost::asio;
using asio::ip::tcp;

Link::Link(asio::io_context& io, bool secure, const std::string& ca_file) : socket_(io), ca_file_(ca_file) {
  if (secure) {
    tls_.emplace(socket_, context_);
  }
}

Status Link::connect(const std::string& host, const std::string& port) {
  const std::string address = (tls_ ? "https://" : "http://") + host + ":" + port;
  boost::system::error_code error;
  tcp::resolver resolver(socket_.get_executor());
  const auto endpoints = resolver.resolve(host, port, error);
  if (!error) {
    asio::connect(socket_, endpoints, error);
  }
  if (error) {
    return fail(ErrorCode::Io, "The daemon at " + address + " cannot be reached: " + error.message() + ".");
  }
  return tls_ ? shake_hands(*tls_, host, address) : Status{};
}

Status Link::shake_hands(TlsStream& stream, const std::string& host, const std::string& address) {
  boost::system::error_code error;
  SSL_CTX_set_min_proto_version(context_.native_handle(), TLS1_2_VERSION);
  if (ca_file_.empty()) {
    error = context_.set_default_verify_paths(error);
  } else if (error = context_.load_verify_file(ca_file_, error); error) {
    return fail(ErrorCode::NotFound, "The file " + ca_file_ + " holds no certificates in PEM, or cannot be read.");
  }
  stream.set_verify_mode(asio::ssl::verify_peer);
  stream.set_verify_callback(asio::ssl::host_name_verification(host));
  boost::system::error_code no_address;
  asio::ip::make_address(host, no_address);
  if (no_address) {
    SSL_set_tlsext_host_name(stream.native_handle(), host.c_str());
  }
  error = stream.handshake(asio::ssl::stream_base::client, error);
  if (!error) {
    return {};
  }
  const long verified = SSL_get_verify_result(stream.native_handle());
  if (verified != X509_V_OK) {
    return fail(ErrorCode::Io, "The daemon at " + address + " shows a certificate that is not trusted (" +
                                   X509_verify_cert_error_string(verified) +
                                   "); name the authority to trust with --ca-file.");
  }
  return fail(ErrorCode::Io, "The daemon at " + address + " does not speak TLS as it should: " + error.message() + ".");
}

}  // namespace driftlab::cli
