#pragma once
/// Base64 (RFC 4648, section 4) through OpenSSL.
#include <optional>
#include <string>
#include <string_view>

namespace driftlab::server {

[[nodiscard]] std::string to_base64(std::string_view bytes);

/// Line breaks count as nothing. Nothing for what is no base64.
[[nodiscard]] std::optional<std::string> from_base64(std::string text);

}  // namespace driftlab::server
