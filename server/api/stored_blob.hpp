#pragma once
/// Stored files are verified before they are used: damaged columns are decoded again from the uploaded bytes, which
/// carry their own checksum as their name; damaged bytes cannot be healed here and are reported.
#include "core/read/byte_source.hpp"
#include "server/store/blobs.hpp"
#include "server/store/budgets.hpp"
#include "server/store/checksums.hpp"

#include <string>
#include <string_view>

namespace driftlab::server {

/// What one upload may become.
[[nodiscard]] DecodeLimits decode_limits(const Budgets& budgets);

enum class BlobState {
  Sound,
  Healed,          ///< the columns were damaged or missing and are made anew
  DamagedBytes,    ///< the columns are sound: results can be computed; the same file uploaded again heals the bytes
  DamagedColumns,  ///< and the bytes too: only the same file uploaded again helps
};

/// `sound`, `healed`, `damaged bytes`, `damaged columns`.
[[nodiscard]] std::string_view name_of(BlobState state);

/// Writes the pyramid of long columns beside them; nothing for short ones. Errors: those of write_trace_pyramid.
[[nodiscard]] Status add_pyramid(const std::filesystem::path& columns);

/// Makes the pyramid of a blob anew where it is damaged, or missing for long columns. For one thread at a time. Errors:
/// Io, DiskFull, Cancelled.
[[nodiscard]] Status mend_pyramid(const BlobStore& blobs, const std::string& sha256, const ReadingPace& pace = {});

/// Reads the columns of a blob back and compares; heals them from the bytes where they are not what was written. A blob
/// of an earlier release gets its checksum here. Errors: Io, DiskFull, Cancelled.
[[nodiscard]] Result<BlobState> verify_columns(BlobStore& blobs, const std::string& sha256, const DecodeLimits& limits,
                                               const ReadingPace& pace = {});

/// The same, and the bytes.
[[nodiscard]] Result<BlobState> verify_blob(BlobStore& blobs, const std::string& sha256, const DecodeLimits& limits,
                                            const ReadingPace& pace = {});

}  // namespace driftlab::server
