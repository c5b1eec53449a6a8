#include "server/webhooks/signature.hpp"

#include <openssl/evp.h>
#include <openssl/hmac.h>
#include <openssl/rand.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <optional>

namespace driftlab::server {
namespace {

constexpr std::string_view kPrefix = "whsec_";
constexpr std::size_t kKeyBytes = 32;  // within the 24 to 64 of the specification
constexpr std::size_t kLongestKeyText = 128;

std::string base64(const unsigned char* bytes, std::size_t count) {
  std::string text(4 * ((count + 2) / 3) + 1, '\0');  // and the zero that OpenSSL writes
  const int length = EVP_EncodeBlock(reinterpret_cast<unsigned char*>(text.data()), bytes, static_cast<int>(count));
  text.resize(static_cast<std::size_t>(length));
  return text;
}

/// The key of a secret; nothing for a text that is none.
std::optional<std::vector<unsigned char>> key_of(std::string_view secret) {
  if (!secret.starts_with(kPrefix)) {
    return std::nullopt;
  }
  const std::string_view text = secret.substr(kPrefix.size());
  if (text.empty() || text.size() % 4 != 0 || text.size() > kLongestKeyText) {
    return std::nullopt;
  }
  std::vector<unsigned char> key(text.size() / 4 * 3);
  const int length =
      EVP_DecodeBlock(key.data(), reinterpret_cast<const unsigned char*>(text.data()), static_cast<int>(text.size()));
  if (length < 0) {
    return std::nullopt;
  }
  const auto padding = std::count(text.end() - 2, text.end(), '=');
  key.resize(static_cast<std::size_t>(length - padding));
  return key;
}

}  // namespace

std::string make_webhook_secret() {
  std::array<unsigned char, kKeyBytes> key{};
  if (RAND_bytes(key.data(), static_cast<int>(key.size())) != 1) {
    std::abort();  // no randomness, no secrets
  }
  return std::string(kPrefix) + base64(key.data(), key.size());
}

std::string webhook_signature(std::string_view id, std::int64_t timestamp_s, std::string_view body,
                              const std::vector<std::string>& secrets) {
  std::string content(id);
  content.append(".").append(std::to_string(timestamp_s)).append(".").append(body);
  std::string header;
  for (const std::string& secret : secrets) {
    const auto key = key_of(secret);
    if (!key) {
      continue;
    }
    std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
    unsigned length = 0;
    if (HMAC(EVP_sha256(), key->data(), static_cast<int>(key->size()),
             reinterpret_cast<const unsigned char*>(content.data()), content.size(), digest.data(),
             &length) == nullptr) {
      continue;
    }
    header.append(header.empty() ? "v1," : " v1,").append(base64(digest.data(), length));
  }
  return header;
}

}  // namespace driftlab::server
