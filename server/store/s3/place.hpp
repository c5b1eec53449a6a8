#pragma once
/// Where recordings lie in an object storage: s3://BUCKET/PREFIX?endpoint=URL&region=NAME.
#include "core/signal/result.hpp"

#include <cstdint>
#include <string>
#include <string_view>

namespace driftlab::server::s3 {

struct Place {
  std::string bucket;
  std::string prefix;  ///< of every key, ends with '/' where it is not empty
  bool secure = true;
  std::string host;  ///< lower case, without brackets
  std::uint16_t port = 443;
  std::string region;
  /// `host` as the Host header writes it, with brackets and with a port that is not the scheme's own.
  [[nodiscard]] std::string authority() const;
};

/// Without `endpoint`: Amazon's of the region; without `region`: us-east-1. A bucket is named in the path, which every
/// S3-compatible storage understands. Error: InvalidArgument, as the end of a sentence that begins with the setting's
/// name; nothing of the text is repeated, which may hold a key by mistake.
[[nodiscard]] Result<Place> read_place(std::string_view text);

}  // namespace driftlab::server::s3
