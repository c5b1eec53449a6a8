#pragma once
/// For whom a proxy asks: the header Forwarded (RFC 7239), believed of listed proxies alone.
#include "server/store/network.hpp"

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace driftlab::server {

/// Whether one of the networks holds the address.
[[nodiscard]] bool is_listed(std::string_view address, const std::vector<Network>& proxies);

/// The address of the client behind the connection of `peer`. Each proxy appends what it saw: read from the right, the
/// first `for` that is no listed proxy is the client, and what stands left of it is a client's own claim. `peer` itself
/// where it is no listed proxy, where there is no header, and where the header is malformed or hides the address
/// (`unknown`, `_name`). `headers`: names in lower case, in order.
[[nodiscard]] std::string client_address(std::string_view peer,
                                         const std::vector<std::pair<std::string, std::string>>& headers,
                                         const std::vector<Network>& proxies);

}  // namespace driftlab::server
