#include "server/http/certificate.hpp"

#include <openssl/err.h>
#include <openssl/ssl.h>

namespace driftlab::server {
namespace {

namespace ssl = boost::asio::ssl;

tl::unexpected<Error> refused(const std::filesystem::path& file, const std::string& why, const char* parameter) {
  ERR_clear_error();
  return fail(ErrorCode::InvalidArgument, "The file " + file.string() + " " + why + ".", {{"parameter", parameter}});
}

}  // namespace

Result<std::shared_ptr<ssl::context>> load_certificate(const CertificateFiles& files) {
  auto context = std::make_shared<ssl::context>(ssl::context::tls_server);
  SSL_CTX* const native = context->native_handle();
  SSL_CTX_set_min_proto_version(native, TLS1_2_VERSION);
  SSL_CTX_set_options(native, SSL_OP_NO_COMPRESSION | SSL_OP_NO_RENEGOTIATION | SSL_OP_CIPHER_SERVER_PREFERENCE);
  SSL_CTX_set_cipher_list(native, "ECDHE+AESGCM:ECDHE+CHACHA20");
  SSL_CTX_set_session_cache_mode(native, SSL_SESS_CACHE_OFF);
  // A key with a passphrase must not ask for it on a terminal.
  SSL_CTX_set_default_passwd_cb(native, [](char*, int, int, void*) { return 0; });
  boost::system::error_code error;
  error = context->use_certificate_chain_file(files.chain.string(), error);
  if (error) {
    return refused(files.chain, "holds no certificate in PEM, or cannot be read", "tls-certificate");
  }
  error = context->use_private_key_file(files.key.string(), ssl::context::pem, error);
  if (error) {
    return refused(files.key,
                   "holds no private key in PEM without a passphrase that belongs to the certificate, or "
                   "cannot be read",
                   "tls-key");
  }
  if (SSL_CTX_check_private_key(native) != 1) {
    return refused(files.key, "holds the key of another certificate", "tls-key");
  }
  return context;
}

}  // namespace driftlab::server
