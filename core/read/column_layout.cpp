#include "core/read/column_layout.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <string>
#include <string_view>

namespace driftlab::column_layout {
namespace {

static_assert(std::endian::native == std::endian::little,
              "the column file is mapped, so the host must be little-endian");

constexpr std::string_view kMagic{
    "\x89"
    "DLCOL\r\n",
    8};
constexpr std::uint32_t kVersion = 1;
constexpr std::size_t kHeaderBytes = 64;
constexpr std::size_t kAlignment = 64;

template <class T>
T load(const std::byte* at) {
  T value{};
  std::memcpy(&value, at, sizeof value);
  return value;
}

template <class T>
void store(std::byte* at, T value) {
  std::memcpy(at, &value, sizeof value);
}

std::uint64_t fnv1a(std::span<const std::byte> bytes, std::uint64_t hash = 0xcbf29ce484222325U) {
  for (const std::byte byte : bytes) {
    hash = (hash ^ std::to_integer<std::uint64_t>(byte)) * 0x100000001b3U;
  }
  return hash;
}

std::vector<std::byte> encode_names(const ColumnNames& names) {
  std::vector<std::byte> bytes;
  for (const std::string& name : names) {
    const std::size_t at = bytes.size();
    bytes.resize(at + 4 + name.size());
    store(bytes.data() + at, static_cast<std::uint32_t>(name.size()));
    std::memcpy(bytes.data() + at + 4, name.data(), name.size());
  }
  return bytes;
}

tl::unexpected<Error> broken(ErrorCode code, const std::filesystem::path& path, const std::string& what) {
  const std::string name = path.filename().string();
  return fail(code, "The column file '" + name + "' " + what + ".", {{"path", name}});
}

}  // namespace

std::uint64_t round_up(std::uint64_t bytes) { return (bytes + kAlignment - 1) / kAlignment * kAlignment; }

std::vector<std::byte> encode_front(const ColumnNames& column_names, std::uint64_t rows) {
  const std::vector<std::byte> names = encode_names(column_names);
  Header header;
  header.columns = column_names.size();
  header.rows = rows;
  header.stride = round_up(rows * sizeof(double));
  header.names_bytes = names.size();
  header.data_offset = round_up(kHeaderBytes + names.size());
  header.file_bytes = header.data_offset + header.columns * header.stride;
  std::vector<std::byte> bytes(header.data_offset);
  std::memcpy(bytes.data(), kMagic.data(), kMagic.size());
  store(bytes.data() + 8, kVersion);
  store(bytes.data() + 12, static_cast<std::uint32_t>(header.columns));
  store(bytes.data() + 16, header.rows);
  store(bytes.data() + 24, header.stride);
  store(bytes.data() + 32, header.data_offset);
  store(bytes.data() + 40, header.names_bytes);
  store(bytes.data() + 48, header.file_bytes);
  store(bytes.data() + 56, fnv1a(names, fnv1a({bytes.data(), 56})));
  std::copy(names.begin(), names.end(), bytes.begin() + kHeaderBytes);
  return bytes;
}

Result<Header> decode_header(std::span<const std::byte> bytes, const std::filesystem::path& path) {
  const std::byte* const at = bytes.data();
  if (bytes.size() < kHeaderBytes) {
    return broken(ErrorCode::Truncated, path, "ends inside its header");
  }
  if (std::memcmp(at, kMagic.data(), kMagic.size()) != 0) {
    return broken(ErrorCode::UnsupportedFormat, path, "does not start with the magic number");
  }
  if (const auto version = load<std::uint32_t>(at + 8); version != kVersion) {
    return broken(ErrorCode::UnsupportedFormat, path, "has version " + std::to_string(version) + ", not 1");
  }
  const Header header{load<std::uint32_t>(at + 12), load<std::uint64_t>(at + 16), load<std::uint64_t>(at + 24),
                      load<std::uint64_t>(at + 32), load<std::uint64_t>(at + 40), load<std::uint64_t>(at + 48)};
  // Divisions and bounds before products: nothing below can overflow for a header that passes the line above it.
  constexpr std::uint64_t kMost = std::uint64_t{1} << 62;
  if (header.columns == 0 || header.columns > kMaxColumns || header.rows > kMost / 8 / header.columns ||
      header.names_bytes > kMost || header.stride != round_up(header.rows * 8) ||
      header.data_offset != round_up(kHeaderBytes + header.names_bytes) ||
      header.file_bytes != header.data_offset + header.columns * header.stride) {
    return broken(ErrorCode::ShapeMismatch, path, "has a header that contradicts itself");
  }
  if (bytes.size() < header.file_bytes) {
    return broken(ErrorCode::Truncated, path,
                  "has " + std::to_string(bytes.size()) + " of " + std::to_string(header.file_bytes) + " bytes");
  }
  if (bytes.size() > header.file_bytes) {
    return broken(ErrorCode::ShapeMismatch, path, "is longer than its header says");
  }
  if (load<std::uint64_t>(at + 56) != fnv1a(bytes.subspan(kHeaderBytes, header.names_bytes), fnv1a({at, 56}))) {
    return broken(ErrorCode::ShapeMismatch, path, "has a header whose checksum is wrong");
  }
  return header;
}

Result<ColumnNames> decode_names(std::span<const std::byte> bytes, const Header& header,
                                 const std::filesystem::path& path) {
  bytes = bytes.subspan(kHeaderBytes, header.names_bytes);
  ColumnNames names;
  while (names.size() < header.columns) {
    if (bytes.size() < 4 || bytes.size() - 4 < load<std::uint32_t>(bytes.data())) {
      return broken(ErrorCode::ShapeMismatch, path, "has column names that run out of their space");
    }
    const std::size_t length = load<std::uint32_t>(bytes.data());
    names.emplace_back(reinterpret_cast<const char*>(bytes.data() + 4), length);
    bytes = bytes.subspan(4 + length);
  }
  if (!bytes.empty()) {
    return broken(ErrorCode::ShapeMismatch, path, "has more column names than columns");
  }
  return names;
}

}  // namespace driftlab::column_layout
