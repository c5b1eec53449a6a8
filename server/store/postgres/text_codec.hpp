#pragma once
/// Any bytes as a text that PostgreSQL takes, and back.
///
/// A text of PostgreSQL is valid UTF-8 without U+0000, while names and targets of requests may hold any byte. Bytes
/// that are not valid UTF-8, the byte 0 and the escape character itself are written as U+0001 and two hexadecimal
/// digits. Every other text, which is every text that people write, stays as it is. Equal texts have equal codes and
/// different ones different codes.
#include <string>
#include <string_view>

namespace driftlab::server {

[[nodiscard]] std::string encode_text(std::string_view text);

/// What `encode_text` made the code of. An escape that it does not write stays as it is.
[[nodiscard]] std::string decode_text(std::string_view code);

}  // namespace driftlab::server
