#pragma once
/// The certificate that the daemon shows, and what it takes of TLS: 1.2 and 1.3, forward secrecy, no compression, no
/// renegotiation.
#include "core/signal/result.hpp"

#include <boost/asio/ssl/context.hpp>

#include <filesystem>
#include <memory>

namespace driftlab::server {

struct CertificateFiles {
  std::filesystem::path chain;  ///< PEM: the daemon's own certificate, then those between it and the root
  std::filesystem::path key;    ///< PEM, without a passphrase
};

/// Reads both and holds them against each other. Errors: InvalidArgument, naming the file.
[[nodiscard]] Result<std::shared_ptr<boost::asio::ssl::context>> load_certificate(const CertificateFiles& files);

}  // namespace driftlab::server
