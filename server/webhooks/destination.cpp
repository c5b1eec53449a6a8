#include "server/webhooks/destination.hpp"

#include "core/signal/text.hpp"

#include <boost/url/parse.hpp>
#include <boost/url/url_view.hpp>

#include <algorithm>
#include <charconv>
#include <optional>

namespace driftlab::server {

namespace ip = boost::asio::ip;

namespace {

constexpr std::size_t kLongestHost = 253;

struct Block {
  const char* base;
  unsigned bits;
};

/// Of IPv4 what is not global: https://www.iana.org/assignments/iana-ipv4-special-registry.
constexpr Block kReserved4[] = {
    {"0.0.0.0", 8},     {"10.0.0.0", 8},      {"100.64.0.0", 10},  {"127.0.0.0", 8},    {"169.254.0.0", 16},
    {"172.16.0.0", 12}, {"192.0.0.0", 24},    {"192.0.2.0", 24},   {"192.88.99.0", 24}, {"192.168.0.0", 16},
    {"198.18.0.0", 15}, {"198.51.100.0", 24}, {"203.0.113.0", 24}, {"224.0.0.0", 4},    {"240.0.0.0", 4},
};
/// Of the global unicast addresses of IPv6 (2000::/3) what is not meant: protocol assignments with Teredo,
/// documentation, 6to4.
constexpr Block kReserved6[] = {{"2001::", 23}, {"2001:db8::", 32}, {"2002::", 16}, {"3fff::", 20}};

bool is_in(const ip::address& address, const Block& block) {
  const ip::address base = ip::make_address(block.base);
  return Network{as_v6(base), block.bits + (base.is_v4() ? 96U : 0U)}.holds(address);
}

tl::unexpected<Error> refuse_url(const std::string& why) {
  return fail(ErrorCode::InvalidArgument, why, {{"parameter", "url"}});
}

/// Names as DNS has them, so that none is an address in disguise (0x7f.1, 2130706433): the last label has a letter.
bool is_host_name(std::string_view host) {
  if (host.empty() || host.size() > kLongestHost || host.front() == '.' || host.front() == '-') {
    return false;
  }
  const bool sound = std::all_of(host.begin(), host.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-' || c == '.' || c == '_';
  });
  std::string_view last = host.ends_with('.') ? host.substr(0, host.size() - 1) : host;
  last = last.substr(last.rfind('.') == std::string_view::npos ? 0 : last.rfind('.') + 1);
  return sound && !last.empty() && !last.starts_with("0x") &&
         std::any_of(last.begin(), last.end(), [](char c) { return c >= 'a' && c <= 'z'; });
}

}  // namespace

std::string Destination::authority() const {
  const std::string text = host.find(':') == std::string::npos ? host : "[" + host + "]";
  return port == (secure ? 443 : 80) ? text : text + ":" + std::to_string(port);
}

bool is_global(const ip::address& address) {
  const ip::address_v6 whole = as_v6(address);
  if (whole.is_v4_mapped()) {
    return std::none_of(std::begin(kReserved4), std::end(kReserved4),
                        [&](const Block& block) { return is_in(whole, block); });
  }
  return Network{ip::make_address_v6("2000::"), 3}.holds(whole) &&
         std::none_of(std::begin(kReserved6), std::end(kReserved6),
                      [&](const Block& block) { return is_in(whole, block); });
}

Result<DestinationGuard> DestinationGuard::with(const std::vector<std::string>& allowed) {
  DestinationGuard guard;
  for (const std::string& entry : allowed) {
    if (const auto network = Network::parse(entry)) {
      guard.networks_.push_back(*network);
    } else if (is_host_name(lower_case(entry))) {
      guard.hosts_.push_back(lower_case(entry));
    } else {
      return fail(
          ErrorCode::InvalidArgument,
          "The setting webhook_allow names hosts, addresses or networks such as 10.1.2.0/24, not '" + entry + "'.",
          {{"parameter", "webhook_allow"}});
    }
  }
  return guard;
}

bool DestinationGuard::names_host(std::string_view host) const {
  return std::find(hosts_.begin(), hosts_.end(), host) != hosts_.end();
}

bool DestinationGuard::names_address(const ip::address& address) const {
  return std::any_of(networks_.begin(), networks_.end(),
                     [&](const Network& network) { return network.holds(address); });
}

bool DestinationGuard::admits(std::string_view host, const ip::address& address) const {
  return is_global(address) || names_address(address) || names_host(host);
}

Result<Destination> DestinationGuard::read(std::string_view url) const {
  const auto parsed = boost::urls::parse_uri(boost::core::string_view(url.data(), url.size()));
  if (!parsed || (parsed->scheme() != "https" && parsed->scheme() != "http")) {
    return refuse_url("The url is written https://HOST/PATH.");
  }
  if (parsed->has_userinfo() || parsed->has_fragment()) {
    return refuse_url("The url has neither a user nor a fragment; the signature says who sends.");
  }
  Destination found;
  found.secure = parsed->scheme() == "https";
  found.host = lower_case(std::string(parsed->encoded_host()));
  if (found.host.size() > 2 && found.host.front() == '[') {
    found.host = found.host.substr(1, found.host.size() - 2);
  }
  found.port = found.secure ? 443 : 80;
  if (parsed->has_port()) {
    // boost::url takes a port of any length and gives its lowest sixteen bits.
    const std::string port(parsed->port());
    const auto [end, fault] = std::from_chars(port.data(), port.data() + port.size(), found.port);
    if (fault != std::errc{} || end != port.data() + port.size()) {
      found.port = 0;
    }
  }
  boost::system::error_code no_address;
  const ip::address address = ip::make_address(found.host, no_address);
  if (found.port == 0 || (no_address && !is_host_name(found.host))) {
    return refuse_url("The url names no host.");
  }
  const bool named = no_address ? names_host(found.host) : names_host(found.host) || names_address(address);
  if (!found.secure && !named) {
    return refuse_url("The url must be https: plain http is for hosts that the daemon was told of (--webhook-allow).");
  }
  if (!no_address && !named && !is_global(address)) {
    return refuse_url("The url leads to " + found.host +
                      ", which is no address of the Internet; the operator allows it by --webhook-allow.");
  }
  found.target = std::string(parsed->encoded_path().empty() ? "/" : parsed->encoded_path());
  if (parsed->has_query()) {
    found.target.append("?").append(std::string_view(parsed->encoded_query().data(), parsed->encoded_query().size()));
  }
  return found;
}

}  // namespace driftlab::server
