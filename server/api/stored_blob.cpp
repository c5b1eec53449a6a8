#include "server/api/stored_blob.hpp"

#include "core/read/format.hpp"
#include "core/read/trace_pyramid.hpp"

#include <array>
#include <fstream>
#include <span>
#include <system_error>

namespace driftlab::server {
namespace {

/// Makes the columns anew. False: the bytes are not what their name says, or no longer decode.
Result<bool> decode_again(BlobStore& blobs, const std::string& sha256, const DecodeLimits& limits) {
  auto incoming = blobs.begin();
  if (!incoming) {
    return fail(incoming.error());
  }
  if (Status reached = blobs.reach(sha256, BlobPart::Bytes); !reached) {
    return fail(reached.error());
  }
  std::ifstream bytes(blobs.bytes_path(sha256), std::ios::binary);
  std::array<char, 65536> piece{};
  while (bytes.read(piece.data(), piece.size()) || bytes.gcount() > 0) {
    const auto count = static_cast<std::size_t>(bytes.gcount());
    if (auto taken = (*incoming)->append(std::as_bytes(std::span(piece).first(count))); !taken) {
      return fail(taken.error());
    }
  }
  if (auto sealed = (*incoming)->seal(); !sealed) {
    return fail(sealed.error());
  }
  if ((*incoming)->sha256() != sha256) {
    return false;
  }
  const auto decoded = decode_file((*incoming)->path(), (*incoming)->columns_path(), limits);
  if (!decoded) {
    const bool storage = decoded.error().code == ErrorCode::Io || decoded.error().code == ErrorCode::DiskFull;
    return storage ? Result<bool>(fail(decoded.error())) : Result<bool>(false);
  }
  if (auto drawn = add_pyramid((*incoming)->columns_path()); !drawn) {
    return fail(drawn.error());
  }
  return (*incoming)->keep().map([] { return true; });
}

}  // namespace

Status add_pyramid(const std::filesystem::path& columns) {
  const auto file = ColumnFile::open(columns);
  if (!file) {
    return fail(file.error());
  }
  return file->rows() < kPyramidRows ? Status{} : write_trace_pyramid(*file, pyramid_path(columns));
}

Status mend_pyramid(const BlobStore& blobs, const std::string& sha256, const ReadingPace& pace) {
  const std::filesystem::path columns = blobs.columns_path(sha256);
  const auto state = check_columns(pyramid_path(columns), pace);
  if (!state) {
    return fail(state.error());
  }
  if (*state == FileState::Sound) {
    return {};
  }
  if (auto made = add_pyramid(columns); !made) {
    return made;
  }
  std::error_code none;
  if (!std::filesystem::exists(columns, none)) {  // removed meanwhile
    std::filesystem::remove(pyramid_path(columns), none);
  }
  const bool drawn = std::filesystem::exists(pyramid_path(columns), none);
  return drawn ? write_columns_checksum(pyramid_path(columns)) : Status{};
}

DecodeLimits decode_limits(const Budgets& budgets) {
  DecodeLimits limits;
  limits.columns_allowance = static_cast<std::uint64_t>(budgets.columns_allowance_bytes);
  limits.columns_ratio = static_cast<std::uint64_t>(budgets.columns_ratio);
  limits.max_notes = static_cast<std::size_t>(budgets.notes_per_recording);
  return limits;
}

std::string_view name_of(BlobState state) {
  switch (state) {
    case BlobState::Sound:
      return "sound";
    case BlobState::Healed:
      return "healed";
    case BlobState::DamagedBytes:
      return "damaged bytes";
    case BlobState::DamagedColumns:
      return "damaged columns";
  }
  return "unknown";
}

Result<BlobState> verify_columns(BlobStore& blobs, const std::string& sha256, const DecodeLimits& limits,
                                 const ReadingPace& pace) {
  if (Status reached = blobs.reach(sha256, BlobPart::Columns); !reached) {
    return fail(reached.error());
  }
  const auto columns = check_columns(blobs.columns_path(sha256), pace);
  if (!columns) {
    return fail(columns.error());
  }
  if (*columns == FileState::Sound) {
    return BlobState::Sound;
  }
  // Columns without a checksum are trusted only after they were made anew: nobody knows what they were.
  const auto made = decode_again(blobs, sha256, limits);
  if (!made) {
    return fail(made.error());
  }
  return *made ? BlobState::Healed : BlobState::DamagedColumns;
}

Result<BlobState> verify_blob(BlobStore& blobs, const std::string& sha256, const DecodeLimits& limits,
                              const ReadingPace& pace) {
  auto columns = verify_columns(blobs, sha256, limits, pace);
  if (!columns || *columns != BlobState::Sound) {
    return columns;
  }
  if (Status reached = blobs.reach(sha256, BlobPart::Bytes); !reached) {
    return fail(reached.error());
  }
  const auto bytes = check_bytes(blobs.bytes_path(sha256), sha256, pace);
  if (!bytes) {
    return fail(bytes.error());
  }
  return *bytes == FileState::Sound ? BlobState::Sound : BlobState::DamagedBytes;
}

}  // namespace driftlab::server
