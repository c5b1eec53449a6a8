#pragma once
/// Signatures of Standard Webhooks 1.0 (https://github.com/standard-webhooks/standard-webhooks): HMAC-SHA256 over
/// `id.timestamp.body` with the key that the secret holds in base64, written `v1,<base64>`.
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace driftlab::server {

/// A fresh secret from the operating system's randomness: `whsec_` and 32 bytes in base64.
[[nodiscard]] std::string make_webhook_secret();

/// The value of the header webhook-signature: one signature for each secret, separated by a space. A secret that is not
/// `whsec_` and base64 has none.
[[nodiscard]] std::string webhook_signature(std::string_view id, std::int64_t timestamp_s, std::string_view body,
                                            const std::vector<std::string>& secrets);

}  // namespace driftlab::server
