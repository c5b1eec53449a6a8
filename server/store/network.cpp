#include "server/store/network.hpp"

#include <charconv>

namespace driftlab::server {

namespace ip = boost::asio::ip;

ip::address_v6 as_v6(const ip::address& address) {
  return address.is_v4() ? ip::make_address_v6(ip::v4_mapped, address.to_v4()) : address.to_v6();
}

std::string plain_text(const ip::address& address) {
  const bool mapped = address.is_v6() && address.to_v6().is_v4_mapped();
  return mapped ? ip::make_address_v4(ip::v4_mapped, address.to_v6()).to_string() : address.to_string();
}

std::optional<Network> Network::parse(std::string_view text) {
  const std::size_t slash = text.find('/');
  boost::system::error_code error;
  const ip::address address = ip::make_address(std::string(text.substr(0, slash)), error);
  if (error) {
    return std::nullopt;
  }
  unsigned bits = address.is_v6() ? 128 : 32;
  if (slash != std::string_view::npos) {
    const char* const end = text.data() + text.size();
    const unsigned most = bits;
    const auto [stop, fault] = std::from_chars(text.data() + slash + 1, end, bits);
    if (fault != std::errc{} || stop != end || bits > most) {
      return std::nullopt;
    }
  }
  return Network{as_v6(address), bits + (address.is_v4() ? 96U : 0U)};
}

bool Network::holds(const ip::address& address) const {
  const auto a = as_v6(address).to_bytes();
  const auto b = base.to_bytes();
  for (unsigned i = 0; i < bits; ++i) {
    const unsigned shift = 7U - i % 8U;
    if (((a[i / 8U] ^ b[i / 8U]) >> shift & 1U) != 0) {
      return false;
    }
  }
  return true;
}

std::vector<Network> networks(const std::vector<std::string>& texts) {
  std::vector<Network> parsed;
  for (const std::string& text : texts) {
    if (const auto network = Network::parse(text)) {
      parsed.push_back(*network);
    }
  }
  return parsed;
}

}  // namespace driftlab::server
