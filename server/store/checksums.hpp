#pragma once
/// Checksums of the files of a blob: its bytes are named by theirs; its decoded columns have one in a file beside them,
/// `<columns file>.sha256`, 64 hexadecimal digits.
#include "core/signal/result.hpp"

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

namespace driftlab::server {

enum class FileState {
  Sound,
  Unknown,  ///< it has no checksum: that was lost, or never written (by an earlier release)
  Damaged,
  Missing,
};

/// Called after each piece that was read, with its size: whoever reads in the background waits here. False: stop.
using ReadingPace = std::function<bool(std::size_t)>;

/// SHA-256 of a file as 64 lower-case digits. Reads without keeping the file in the system's cache where `pace` is
/// given. Errors: NotFound, Io; Cancelled where `pace` says stop.
[[nodiscard]] Result<std::string> sha256_of_file(const std::filesystem::path& path, const ReadingPace& pace = {});

/// Writes the checksum of a columns file beside it, durably. Errors: NotFound, Io, DiskFull.
[[nodiscard]] Status write_columns_checksum(const std::filesystem::path& columns);
[[nodiscard]] std::filesystem::path columns_checksum_path(const std::filesystem::path& columns);

/// Errors: Io, Cancelled. That the file cannot be read because the disk fails is an error, not damage.
[[nodiscard]] Result<FileState> check_columns(const std::filesystem::path& columns, const ReadingPace& pace = {});
[[nodiscard]] Result<FileState> check_bytes(const std::filesystem::path& bytes, std::string_view sha256,
                                            const ReadingPace& pace = {});

}  // namespace driftlab::server
