#pragma once
/// Which bytes of a representation a GET asks for (RFC 9110 section 14).
#include "server/http/message.hpp"

#include <cstdint>
#include <string_view>

namespace driftlab::server {

struct WantedBytes {
  enum class Kind {
    Whole,  ///< 200: nothing else was asked for, or what was asked for is no range of bytes
    Part,   ///< 206
    None    ///< 416: the range begins behind the end
  };
  Kind kind = Kind::Whole;
  std::uint64_t first = 0;
  std::uint64_t length = 0;
};

/// Reads Range of a GET, and If-Range, which must be `etag` for the range to count. One range of bytes is taken;
/// several at once are answered with the whole, as the RFC allows.
[[nodiscard]] WantedBytes wanted_bytes(const Request& request, std::uint64_t size, std::string_view etag);

}  // namespace driftlab::server
