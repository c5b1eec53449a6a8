#include "server/http/forwarded.hpp"

#include "core/signal/text.hpp"
#include "server/http/names.hpp"

#include <boost/asio/ip/address.hpp>

#include <algorithm>
#include <optional>

namespace driftlab::server {
namespace {

/// Parts of `text` between separators that stand outside quotes.
std::vector<std::string_view> parts_outside_quotes(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  bool quoted = false;
  std::size_t begin = 0;
  for (std::size_t i = 0; i <= text.size(); ++i) {
    if (i < text.size() && text[i] == '"') {
      quoted = !quoted;
    }
    if (i == text.size() || (text[i] == separator && !quoted)) {
      parts.push_back(trimmed(text.substr(begin, i - begin)));
      begin = i + 1;
    }
  }
  return parts;
}

/// The address of a node: `192.0.2.1`, `"192.0.2.1:80"`, `"[2001:db8::1]"`, `"[2001:db8::1]:80"`.
std::optional<std::string> address_of(std::string_view node) {
  if (node.size() >= 2 && node.front() == '"' && node.back() == '"') {
    node = node.substr(1, node.size() - 2);
  }
  if (node.starts_with('[')) {
    const std::size_t end = node.find(']');
    node = end == std::string_view::npos ? std::string_view() : node.substr(1, end - 1);
  } else if (std::count(node.begin(), node.end(), ':') == 1) {
    node = node.substr(0, node.find(':'));
  }
  boost::system::error_code error;
  const auto parsed = boost::asio::ip::make_address(std::string(node), error);
  return error ? std::nullopt : std::optional(plain_text(parsed));
}

/// The address that an element `for=…;proto=…` names.
std::optional<std::string> address_in(std::string_view element) {
  for (const std::string_view pair : parts_outside_quotes(element, ';')) {
    const std::size_t equals = pair.find('=');
    if (equals != std::string_view::npos && same_name(trimmed(pair.substr(0, equals)), "for")) {
      return address_of(trimmed(pair.substr(equals + 1)));
    }
  }
  return std::nullopt;
}

}  // namespace

bool is_listed(std::string_view address, const std::vector<Network>& proxies) {
  if (proxies.empty()) {
    return false;
  }
  boost::system::error_code error;
  const auto parsed = boost::asio::ip::make_address(std::string(address), error);
  return !error &&
         std::any_of(proxies.begin(), proxies.end(), [&](const Network& network) { return network.holds(parsed); });
}

std::string client_address(std::string_view peer, const std::vector<std::pair<std::string, std::string>>& headers,
                           const std::vector<Network>& proxies) {
  std::string client(peer);
  if (!is_listed(peer, proxies)) {
    return client;
  }
  std::vector<std::string_view> elements;
  for (const auto& [name, value] : headers) {
    if (name == "forwarded") {
      const auto more = parts_outside_quotes(value, ',');
      elements.insert(elements.end(), more.begin(), more.end());
    }
  }
  for (auto element = elements.rbegin(); element != elements.rend() && is_listed(client, proxies); ++element) {
    auto address = address_in(*element);
    if (!address) {
      return std::string(peer);
    }
    client = std::move(*address);
  }
  return client;
}

}  // namespace driftlab::server
