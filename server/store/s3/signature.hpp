#pragma once
/// AWS Signature Version 4 in the header Authorization (Amazon S3 API Reference, "Authenticating Requests: Using the
/// Authorization Header", payload in one chunk).
#include "server/store/clock.hpp"

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace driftlab::server::s3 {

/// Never logged, shown or put into an error.
struct Credentials {
  std::string key_id;
  std::string secret;
  std::string session_token;  ///< of a temporary key; else empty
};

using Pairs = std::vector<std::pair<std::string, std::string>>;

/// What is signed of a request.
struct Signed {
  std::string verb;
  std::string path;  ///< not yet encoded, begins with '/'
  Pairs query;       ///< not yet encoded
  Pairs headers;     ///< every header that is sent and signed, names in lower case, `host` among them
  std::string payload_sha256;
};

/// Every byte but A-Z a-z 0-9 - . _ ~ as %XX; a slash too, unless told to keep it.
[[nodiscard]] std::string percent_encoded(std::string_view text, bool keeps_slash = false);

/// `a=b&c=`, encoded and sorted.
[[nodiscard]] std::string canonical_query(const Pairs& query);

/// The headers that make a request one of the key's: those given, x-amz-date, x-amz-content-sha256, perhaps
/// x-amz-security-token, and authorization.
[[nodiscard]] Pairs signed_headers(const Signed& request, const Credentials& credentials, std::string_view region,
                                   UtcMicros now);

}  // namespace driftlab::server::s3
