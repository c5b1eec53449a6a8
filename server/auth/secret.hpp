#pragma once
/// The text of a token: `dl_` and 30 characters of base 62, then `_` and the CRC-32 of all before as six more.
///
/// 30 characters hold 178 random bits. Scanners find leaked tokens by their shape, and the checksum tells a typing
/// error from a token that was revoked without asking anybody.
#include "server/store/digest.hpp"

#include <string>
#include <string_view>

namespace driftlab::server {

/// A fresh secret, from the operating system's randomness.
[[nodiscard]] std::string make_secret();
/// Whether the text has the shape of a token and its checksum is right.
[[nodiscard]] bool is_secret(std::string_view text);
/// A fresh public id: eight characters of base 62.
[[nodiscard]] std::string make_token_id();
[[nodiscard]] bool is_token_id(std::string_view text);
/// A fresh secret that no person types, of a session or a live recording: 64 hexadecimal digits, 256 random bits.
[[nodiscard]] std::string make_random_secret();
/// Compares two digests in a time that does not depend on them.
[[nodiscard]] bool is_same_digest(std::string_view a, std::string_view b);

}  // namespace driftlab::server
