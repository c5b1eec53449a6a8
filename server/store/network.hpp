#pragma once
/// Addresses of either family as one kind, and networks of them.
///
/// An IPv4 address is ::ffff:a.b.c.d among those of IPv6 (RFC 4291, 2.5.5.2), and that is how it comes in on a socket
/// that listens for both: in whichever form it was written, it is the same address.
#include <boost/asio/ip/address.hpp>

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace driftlab::server {

[[nodiscard]] boost::asio::ip::address_v6 as_v6(const boost::asio::ip::address& address);

/// The address as people write it: ::ffff:192.0.2.1 is 192.0.2.1.
[[nodiscard]] std::string plain_text(const boost::asio::ip::address& address);

/// ADDRESS or ADDRESS/BITS.
struct Network {
  boost::asio::ip::address_v6 base;  ///< IPv4 as ::ffff:a.b.c.d
  unsigned bits = 128;               ///< of `base`

  [[nodiscard]] static std::optional<Network> parse(std::string_view text);
  [[nodiscard]] bool holds(const boost::asio::ip::address& address) const;
};

/// The networks among `texts`.
[[nodiscard]] std::vector<Network> networks(const std::vector<std::string>& texts);

}  // namespace driftlab::server
