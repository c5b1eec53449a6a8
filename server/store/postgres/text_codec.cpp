#include "server/store/postgres/text_codec.hpp"

#include <cstdint>

namespace driftlab::server {
namespace {

constexpr char kEscape = '\x01';
constexpr std::string_view kDigits = "0123456789abcdef";

/// The bytes of the character that `text` begins with, by the table of well-formed sequences (Unicode 15, table 3-7); 0
/// where it begins with none.
std::size_t character_length(std::string_view text) {
  const auto byte = [&](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0U; };
  const unsigned first = byte(0);
  if (first < 0x80) {
    return 1;
  }
  const std::size_t length = first >= 0xC2 && first < 0xE0 ? 2 : first >= 0xE0 && first < 0xF0 ? 3 : 4;
  if (first < 0xC2 || first > 0xF4) {
    return 0;
  }
  const unsigned least = first == 0xE0 ? 0xA0U : first == 0xF0 ? 0x90U : 0x80U;
  const unsigned most = first == 0xED ? 0x9FU : first == 0xF4 ? 0x8FU : 0xBFU;
  if (byte(1) < least || byte(1) > most) {
    return 0;
  }
  for (std::size_t i = 2; i < length; ++i) {
    if ((byte(i) & 0xC0U) != 0x80U) {
      return 0;
    }
  }
  return length;
}

int digit_value(char digit) {
  const std::size_t value = kDigits.find(digit);
  return value == std::string_view::npos ? -1 : static_cast<int>(value);
}

}  // namespace

std::string encode_text(std::string_view text) {
  std::string code;
  code.reserve(text.size());
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t length = character_length(text.substr(at, 4));
    const char first = text[at];
    if (length > 0 && first != '\0' && first != kEscape) {
      code.append(text.substr(at, length));
      at += length;
      continue;
    }
    const auto byte = static_cast<unsigned char>(first);
    code.push_back(kEscape);
    code.push_back(kDigits[byte >> 4U]);
    code.push_back(kDigits[byte & 15U]);
    ++at;
  }
  return code;
}

std::string decode_text(std::string_view code) {
  if (code.find(kEscape) == std::string_view::npos) {
    return std::string(code);
  }
  std::string text;
  text.reserve(code.size());
  for (std::size_t at = 0; at < code.size(); ++at) {
    if (code[at] == kEscape && at + 2 < code.size()) {
      const int high = digit_value(code[at + 1]);
      const int low = digit_value(code[at + 2]);
      if (high >= 0 && low >= 0) {
        text.push_back(static_cast<char>(high * 16 + low));
        at += 2;
        continue;
      }
    }
    text.push_back(code[at]);
  }
  return text;
}

}  // namespace driftlab::server
