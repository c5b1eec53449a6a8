#pragma once
/// The bytes at the front of a column file (layout in column_file.hpp). Internal to core/read.
#include "core/signal/recording.hpp"
#include "core/signal/result.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

namespace driftlab::column_layout {

inline constexpr std::size_t kMaxColumns = 65535;

struct Header {
  std::uint64_t columns = 0;
  std::uint64_t rows = 0;
  std::uint64_t stride = 0;
  std::uint64_t data_offset = 0;
  std::uint64_t names_bytes = 0;
  std::uint64_t file_bytes = 0;
};

/// Header, names and padding: every byte before the first sample of a table of `rows` rows.
[[nodiscard]] std::vector<std::byte> encode_front(const ColumnNames& names, std::uint64_t rows);

/// The next multiple of 64 bytes.
[[nodiscard]] std::uint64_t round_up(std::uint64_t bytes);

/// The header of a whole file, checked so that every access it leads to stays inside `bytes`.
[[nodiscard]] Result<Header> decode_header(std::span<const std::byte> bytes, const std::filesystem::path& path);

/// The names of a file whose header is `header`.
[[nodiscard]] Result<ColumnNames> decode_names(std::span<const std::byte> bytes, const Header& header,
                                               const std::filesystem::path& path);

}  // namespace driftlab::column_layout
