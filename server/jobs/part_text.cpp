#include "server/jobs/part_text.hpp"

#include "server/store/base64.hpp"
#include "server/store/digest.hpp"

namespace driftlab::server {
namespace {

constexpr std::size_t kChecksum = 64;

std::string checksum_of(std::string_view shape, std::string_view bytes) {
  std::string all(DRIFTLAB_VERSION);
  all.append(" ").append(shape).append(" ").append(bytes);
  return sha256_hex(all);
}

}  // namespace

std::string sealed_part(std::string_view shape, std::string_view bytes) {
  return checksum_of(shape, bytes) + to_base64(bytes);
}

std::optional<std::string> opened_part(std::string_view shape, std::string_view text) {
  if (text.size() < kChecksum) {
    return std::nullopt;
  }
  auto bytes = from_base64(std::string(text.substr(kChecksum)));
  return bytes && checksum_of(shape, *bytes) == text.substr(0, kChecksum) ? std::move(bytes) : std::nullopt;
}

}  // namespace driftlab::server
