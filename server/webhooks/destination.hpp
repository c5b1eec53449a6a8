#pragma once
/// The destinations to which the daemon may send webhook messages: addresses of the public Internet, by HTTPS.
///
/// Whoever may make webhooks could otherwise have the daemon speak with what only the daemon can reach: other services
/// of its machine, the cloud's metadata, printers (server-side request forgery). So every address is judged after the
/// name was resolved, and the connection goes to the address that was judged. The operator names exceptions by
/// `--webhook-allow`: a host name, an address, or a network as ADDRESS/BITS.
#include "core/signal/result.hpp"
#include "server/store/network.hpp"

#include <boost/asio/ip/address.hpp>

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace driftlab::server {

/// The parts of a URL that a request needs.
struct Destination {
  bool secure = true;
  std::string host;  ///< lower case, without brackets
  std::uint16_t port = 443;
  std::string target = "/";  ///< path and query
  /// `host` as the Host header writes it, with brackets and with a port that is not the scheme's own.
  [[nodiscard]] std::string authority() const;
};

/// Whether an address belongs to the global Internet: not loopback, private, link-local, multicast, documentation,
/// benchmarking, carrier-grade NAT, 6to4, Teredo, NAT64 or reserved (IANA special-purpose registries, RFC 6890). An
/// IPv4 address inside an IPv6 one is judged as itself.
[[nodiscard]] bool is_global(const boost::asio::ip::address& address);

class DestinationGuard {
 public:
  /// Nothing but global addresses.
  DestinationGuard() = default;
  /// With exceptions. Error: InvalidArgument for an entry that is neither name, address nor network.
  [[nodiscard]] static Result<DestinationGuard> with(const std::vector<std::string>& allowed);

  /// The parts of a URL that may be used. Plain http is for hosts that were named alone. Errors: InvalidArgument.
  [[nodiscard]] Result<Destination> read(std::string_view url) const;
  /// Whether a connection to that address of that host may be opened.
  [[nodiscard]] bool admits(std::string_view host, const boost::asio::ip::address& address) const;

 private:
  [[nodiscard]] bool names_host(std::string_view host) const;
  [[nodiscard]] bool names_address(const boost::asio::ip::address& address) const;

  std::vector<std::string> hosts_;
  std::vector<Network> networks_;
};

}  // namespace driftlab::server
