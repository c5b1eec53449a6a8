#include "server/settings.hpp"

#include "core/signal/text.hpp"

#include <boost/asio/ip/address.hpp>

#include <algorithm>
#include <charconv>

namespace driftlab::server {

Result<ListenAddress> listen_address(const Settings& settings) {
  const std::size_t colon = settings.listen.rfind(':');
  ListenAddress result;
  bool sound = colon != std::string::npos && colon > 0;
  if (sound) {
    result.address = settings.listen.substr(0, colon);
    if (result.address.size() > 2 && result.address.front() == '[' && result.address.back() == ']') {
      result.address = result.address.substr(1, result.address.size() - 2);
    }
    const char* const end = settings.listen.data() + settings.listen.size();
    const auto [stop, error] = std::from_chars(settings.listen.data() + colon + 1, end, result.port);
    sound = error == std::errc{} && stop == end;
  }
  boost::system::error_code error;
  (void)boost::asio::ip::make_address(result.address, error);
  if (!sound || error) {
    return fail(
        ErrorCode::InvalidArgument,
        "The address to listen on is written IP:PORT, for example 127.0.0.1:8477, not '" + settings.listen + "'.",
        {{"parameter", "listen"}});
  }
  if (settings.tls_certificate.empty() != settings.tls_key.empty()) {
    return fail(ErrorCode::InvalidArgument, "--tls-certificate and --tls-key are given together.",
                {{"parameter", settings.tls_key.empty() ? "tls-key" : "tls-certificate"}});
  }
  return result;
}

Status require_safe_address(const Settings& settings, const ListenAddress& address, bool has_tokens) {
  boost::system::error_code error;
  const bool loopback = boost::asio::ip::make_address(address.address, error).is_loopback();
  const bool tls = !settings.tls_certificate.empty();
  if (loopback || settings.insecure || (tls && (has_tokens || settings.require_tokens))) {
    return {};
  }
  return fail(
      ErrorCode::InvalidArgument,
      "Beyond this machine the daemon listens with TLS (--tls-certificate, --tls-key) and tokens "
      "(--require-tokens, or `driftlabd token create`) only; --insecure overrides this for a network you trust.",
      {{"parameter", "listen"}});
}

std::string without_password(const std::string& uri) {
  std::string shown = uri;
  const std::size_t scheme = shown.find("://");
  const std::size_t begin = scheme == std::string::npos ? 0 : scheme + 3;
  // Of the user's part, which ends at the last @ before the parameters, the password follows the first colon.
  const std::size_t at = shown.rfind('@', shown.find('?', begin));
  const std::size_t colon = shown.find(':', begin);
  if (at != std::string::npos && at > begin && colon < at) {
    shown.replace(colon + 1, at - colon - 1, "***");
  }
  constexpr std::string_view kParameter = "password=";
  for (std::size_t found = shown.find(kParameter); found != std::string::npos;
       found = shown.find(kParameter, found + 1)) {
    const std::size_t value = found + kParameter.size();
    const std::size_t stop = std::min(shown.find('&', value), shown.size());
    shown.replace(value, stop - value, "***");
  }
  return shown;
}

std::vector<std::string> allowed_hosts(const Settings& settings, const ListenAddress& address) {
  std::vector<std::string> hosts{"localhost", "127.0.0.1", "[::1]"};
  hosts.push_back(address.address.find(':') == std::string::npos ? address.address : "[" + address.address + "]");
  for (const std::string& host : settings.allow_host) {
    hosts.push_back(lower_case(host));
  }
  return hosts;
}

}  // namespace driftlab::server
