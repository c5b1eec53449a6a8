#include "server/auth/secret.hpp"

#include <openssl/crypto.h>
#include <openssl/rand.h>
#include <zlib.h>

#include <algorithm>
#include <cstdlib>

namespace driftlab::server {
namespace {

constexpr std::string_view kBase62 = "0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz";
constexpr std::string_view kPrefix = "dl_";
constexpr std::size_t kRandomLength = 30;
constexpr std::size_t kSumLength = 6;

unsigned char random_byte() {
  unsigned char byte = 0;
  if (RAND_bytes(&byte, 1) != 1) {
    std::abort();  // no randomness, no secrets
  }
  return byte;
}

/// Bytes from 248 on are drawn again, so that all characters are equally likely.
std::string random_base62(std::size_t length) {
  std::string text;
  while (text.size() < length) {
    const unsigned char byte = random_byte();
    if (byte < 248) {
      text += kBase62[byte % 62U];
    }
  }
  return text;
}

std::string checksum_of(std::string_view text) {
  auto sum = static_cast<std::uint64_t>(
      crc32(0, reinterpret_cast<const unsigned char*>(text.data()), static_cast<unsigned>(text.size())));
  std::string digits(kSumLength, '0');
  for (auto digit = digits.rbegin(); digit != digits.rend(); ++digit) {
    *digit = kBase62[sum % 62U];
    sum /= 62U;
  }
  return digits;
}

}  // namespace

std::string make_secret() {
  const std::string text = std::string(kPrefix) + random_base62(kRandomLength);
  return text + '_' + checksum_of(text);
}

bool is_secret(std::string_view text) {
  const std::size_t body = kPrefix.size() + kRandomLength;
  if (text.size() != body + 1 + kSumLength || !text.starts_with(kPrefix) || text[body] != '_') {
    return false;
  }
  const std::string_view random = text.substr(kPrefix.size(), kRandomLength);
  return random.find_first_not_of(kBase62) == std::string_view::npos &&
         text.substr(body + 1) == checksum_of(text.substr(0, body));
}

std::string make_token_id() { return random_base62(8); }

bool is_token_id(std::string_view text) {
  return text.size() == 8 && text.find_first_not_of(kBase62) == std::string_view::npos;
}

std::string make_random_secret() {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string text;
  for (int i = 0; i < 32; ++i) {
    const unsigned char byte = random_byte();
    text += {kDigits[byte >> 4U], kDigits[byte & 15U]};
  }
  return text;
}

bool is_same_digest(std::string_view a, std::string_view b) {
  return a.size() == b.size() && CRYPTO_memcmp(a.data(), b.data(), a.size()) == 0;
}

}  // namespace driftlab::server
