#pragma once
/// SHA-256 (FIPS 180-4) through OpenSSL: the name of blobs, jobs, bodies and migrations.
#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace driftlab::server {

/// A digest over bytes that arrive in pieces. Movable, not thread safe.
class Sha256 {
 public:
  Sha256();
  Sha256(const Sha256&) = delete;
  Sha256& operator=(const Sha256&) = delete;
  Sha256(Sha256&&) noexcept;
  Sha256& operator=(Sha256&&) noexcept;
  ~Sha256();

  void update(std::span<const std::byte> bytes);
  /// Closes the digest: 64 lower-case hexadecimal digits. Call once.
  [[nodiscard]] std::string finish();

 private:
  struct Context;
  std::unique_ptr<Context> context_;
};

/// The digest of a text as 64 lower-case hexadecimal digits.
[[nodiscard]] std::string sha256_hex(std::string_view text);

/// True for 64 lower-case hexadecimal digits: the only hashes that become part of a path.
[[nodiscard]] bool is_sha256_hex(std::string_view text);

}  // namespace driftlab::server
