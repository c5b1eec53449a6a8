#pragma once
/// Bytes of a recording, pulled piece by piece and decompressed on the way.
///
/// Two floors: a `ByteReader` delivers bytes in whatever pieces it has (a file, memory, a decompressor on top of
/// another reader); a `ByteSource` buffers one reader and lets a decoder look ahead. Memory does not grow with the
/// input.
#include "core/signal/result.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace driftlab {

/// What a decoder may spend on one input. The defaults hold for uploads from strangers.
///
/// Decompression budget = min(max_expanded_bytes, expansion_allowance + expansion_ratio * compressed size). Recordings
/// of sensors expand 3 to 20 times; deflate can reach 1032 times, xz and zstd far more, which is what the budget stops.
struct DecodeLimits {
  std::uint64_t max_expanded_bytes = std::uint64_t{32} << 30;  ///< absolute cap of the decompressed size [bytes]
  std::uint64_t expansion_allowance = std::uint64_t{256} << 20;
  std::uint64_t expansion_ratio = 200;
  std::uint64_t max_decoder_memory = std::uint64_t{256} << 20;  ///< dictionary or window a stream may demand [bytes]
  std::size_t max_tables_bytes = std::size_t{256} << 20;        ///< samples in memory, in formats of several tables
  std::size_t max_line_bytes = std::size_t{1} << 20;            ///< one line of a text format
  std::size_t max_columns = 1024;
  std::size_t max_name_bytes = 256;  ///< one column name
  /// Most bytes of decoded columns = min(8 * max_expanded_bytes, columns_allowance + columns_ratio * input size).
  /// Decoded, a text with one digit in each cell is four times as large and packed counts of one bit 64 times, in
  /// addition to the factor of a compression.
  std::uint64_t columns_allowance = std::uint64_t{32} << 30;
  std::uint64_t columns_ratio = 1600;
  std::size_t max_notes = 64;         ///< sentences about the file; the rest is counted
  std::size_t max_note_bytes = 1024;  ///< one such sentence

  [[nodiscard]] std::uint64_t expanded_budget(std::uint64_t compressed_bytes) const;
  [[nodiscard]] std::uint64_t columns_budget(std::uint64_t input_bytes) const;
};

/// Delivers bytes in order. Not thread safe.
class ByteReader {
 public:
  ByteReader() = default;
  ByteReader(const ByteReader&) = delete;
  ByteReader& operator=(const ByteReader&) = delete;
  virtual ~ByteReader() = default;

  /// Writes up to `into.size()` bytes (at least 1 unless the input has ended) and says how many; 0 is the end.
  [[nodiscard]] virtual Result<std::size_t> read(std::span<char> into) = 0;

  /// Fraction 0..1 of the underlying input taken so far.
  [[nodiscard]] virtual double fraction() const = 0;

  /// Size of the underlying input [bytes].
  [[nodiscard]] virtual std::uint64_t size() const = 0;

  /// The file of which these are the unchanged bytes; nothing if they come from memory or were decompressed.
  [[nodiscard]] virtual std::optional<std::filesystem::path> path() const { return std::nullopt; }
};

/// A file. Errors: NotFound, Io; the field `path` is the file name without its directory.
[[nodiscard]] Result<std::unique_ptr<ByteReader>> open_file_reader(const std::filesystem::path& path);

/// Bytes in memory, which must outlive the reader, in pieces of at most `piece` bytes (tests feed one at a time).
[[nodiscard]] std::unique_ptr<ByteReader> make_memory_reader(std::string_view bytes,
                                                             std::size_t piece = static_cast<std::size_t>(-1));

enum class Compression { None, Gzip, Xz, Zstd };

/// `none`, `gzip`, `xz`, `zstd`.
[[nodiscard]] std::string_view name_of(Compression compression);

/// The compression whose magic number `head` starts with (RFC 1952, xz file format 1.1, RFC 8878).
[[nodiscard]] Compression sniff_compression(std::string_view head);

/// A reader with a window of look-ahead. Not thread safe.
class ByteSource {
 public:
  explicit ByteSource(std::unique_ptr<ByteReader> reader);

  /// The next bytes without taking them: at least `at_least` of them unless the input ends sooner, usually many more.
  /// Empty: the input has ended. The view is valid until the next call of view(). `at_least` <= 16 MiB.
  [[nodiscard]] Result<std::string_view> view(std::size_t at_least = 1);

  /// Takes `count` bytes of the last view.
  void consume(std::size_t count);

  [[nodiscard]] std::uint64_t offset() const { return offset_; }  ///< bytes taken so far
  [[nodiscard]] double fraction() const { return reader_->fraction(); }

  [[nodiscard]] std::uint64_t input_size() const { return reader_->size(); }

  /// The path of the reader, for formats that a library opens by its path instead of reading a stream.
  [[nodiscard]] std::optional<std::filesystem::path> path() const { return reader_->path(); }

 private:
  std::unique_ptr<ByteReader> reader_;
  std::vector<char> buffer_;
  std::size_t begin_ = 0;
  std::size_t end_ = 0;
  std::uint64_t offset_ = 0;
  bool ended_ = false;
};

/// A reader of what `compressed` holds: concatenated members, streams or frames read as one, as gzip(1), xz(1) and
/// zstd(1) do. Checksums in the stream are verified. Errors while reading: CorruptCompression, Truncated (the stream
/// ends early), DecompressionLimit (over the budget of `limits`, or a dictionary larger than max_decoder_memory).
[[nodiscard]] Result<std::unique_ptr<ByteReader>> make_decompressor(Compression compression, ByteSource compressed,
                                                                    const DecodeLimits& limits);

}  // namespace driftlab
