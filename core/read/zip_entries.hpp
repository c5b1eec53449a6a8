#pragma once
/// The files inside a ZIP archive, one after the other, as they stream by. Internal to core/read.
///
/// libarchive reads the local headers in order and never seeks; names are only looked at, never used as paths. Expanded
/// bytes count against the budget of decompression (core/read/byte_source.hpp), all files together.
#include "core/read/byte_source.hpp"

#include <functional>
#include <memory>
#include <string>

namespace driftlab {

/// Calls `take` with each file's path inside the archive and its bytes; what `take` does not read is skipped. Its error
/// ends the walk. Errors beside that: CorruptCompression, Truncated, DecompressionLimit, UnsupportedType (encrypted),
/// those of `source`. `what` names the archive in sentences: "ZIP archive".
[[nodiscard]] Status for_each_zip_entry(
    ByteSource& source, const DecodeLimits& limits,
    const std::function<Status(const std::string& path, ByteSource& content)>& take);

/// True if `head` starts a ZIP archive.
[[nodiscard]] bool is_zip(std::string_view head);

/// The names of the files of an archive, as local headers without contents, for zip_holds(): an image of a megabyte may
/// come before the first table. From the first kSniffBytes and, where `source` is a file, the archive's directory;
/// else, or where that cannot be read, as far as the first 16 MiB show. At most twice 16 MiB. Errors: those of
/// `source`.
[[nodiscard]] Result<std::string> zip_headers(ByteSource& source);

/// True if `head` starts a ZIP archive and one of the paths in it ends with `suffix`, as far as `head` shows.
[[nodiscard]] bool zip_holds(std::string_view head, std::string_view suffix);

}  // namespace driftlab
