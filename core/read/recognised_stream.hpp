#pragma once
/// Bytes whose compression and format are known. Internal to core/read.
#include "core/read/format.hpp"

namespace driftlab {

struct RecognisedStream {
  ByteSource source;  ///< decompressed, at its first byte
  Compression compression = Compression::None;
  const Format* format = nullptr;  ///< never null
};

/// Where the bytes of a compressed file end.
enum class StreamEnd {
  OfTheFile,  ///< a stream that is not complete is Truncated
  Anywhere,   ///< it ends there: the rest of the file is not at hand
};

/// Decompresses once and asks every format for the surest. Errors: EmptyInput, UnsupportedFormat (with what it looks
/// like), those of make_decompressor.
[[nodiscard]] Result<RecognisedStream> recognise_stream(std::unique_ptr<ByteReader> reader, const DecodeLimits& limits,
                                                        StreamEnd end = StreamEnd::OfTheFile);

/// Refuses a layout that names two columns alike. Error: DuplicateColumn.
[[nodiscard]] Status check_distinct_names(const ColumnLayout& layout);

}  // namespace driftlab
