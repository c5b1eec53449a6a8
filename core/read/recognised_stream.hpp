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

/// The layout with its names in UTF-8; refuses one that names two columns alike. Error: DuplicateColumn.
[[nodiscard]] Result<ColumnLayout> sound_layout(const ColumnLayout& layout);

/// What a decoder says of a file, in UTF-8 whatever names it holds; a note is cut to its limit.
[[nodiscard]] std::string sound_note(std::string_view note, const DecodeLimits& limits);
[[nodiscard]] Error sound_error(Error error);

}  // namespace driftlab
