#pragma once
/// A chunk of a container file: a stretch of its bytes, packed or not, read as a source of its own. Internal to
/// core/read.
///
/// libarchive unpacks bzip2, LZ4 frames and zstd as the bytes stream by. What all chunks of a file expand to counts
/// against one budget, that of decompression (core/read/byte_source.hpp).
#include "core/read/byte_source.hpp"
#include "core/signal/progress.hpp"

#include <cstdint>
#include <functional>
#include <optional>
#include <string_view>

namespace driftlab {

enum class Packing { None, Bzip2, Lz4, Zstd };

/// `none`, `` (both None), `bz2`, `lz4`, `zstd`; nothing for any other name.
[[nodiscard]] std::optional<Packing> packing_of(std::string_view name);

struct ChunkKind {
  Packing packing = Packing::None;
  std::optional<std::uint32_t> crc32 = std::nullopt;  ///< of the content
};

/// What is left to expand of one file.
struct ExpansionBudget {
  explicit ExpansionBudget(std::uint64_t bytes) : total(bytes), left(bytes) {}
  std::uint64_t total;
  std::uint64_t left;
};

/// Reads the content of a chunk; true if it ends where a record ends.
using ReadChunk = std::function<Result<bool>(ByteSource& content)>;

/// Hands the content of the next `length` bytes of `outer` to `read`, which may leave some, and takes them. False where
/// the file ends within the chunk. Errors: those of `read` and of `outer`; CorruptCompression (it does not
/// decompress, or its checksum is wrong) and ShapeMismatch (the content ends within a record) naming the byte at which
/// the chunk begins; DecompressionLimit; Cancelled.
[[nodiscard]] Result<bool> read_chunk(ByteSource& outer, std::uint64_t length, const ChunkKind& kind,
                                      ExpansionBudget& budget, const RunControl& control, const ReadChunk& read);

}  // namespace driftlab
