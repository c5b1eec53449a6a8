#pragma once
/// The registry of recording formats, and the one call that turns any of them into a column file.
///
/// A format is one file in this folder that defines one `Format`, and one line in formats.hpp. It is recognised by
/// content, never by file name. Everything else (decompression, limits, the column file, the malformed-input suite, the
/// fuzz target) works from that declaration.
#include "core/read/byte_source.hpp"
#include "core/signal/progress.hpp"
#include "core/signal/recording.hpp"
#include "core/signal/result.hpp"

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace driftlab {

/// What a file says about its columns.
struct ColumnLayout {
  ColumnNames names;        ///< the file's own names; "0", "1", ... in a format or file without names
  bool has_header = false;  ///< the names came from the file
};

/// Where a decoder puts samples. begin() once, then any mixture of rows() and column(). Errors are passed on unchanged.
class ColumnSink {
 public:
  ColumnSink() = default;
  ColumnSink(const ColumnSink&) = delete;
  ColumnSink& operator=(const ColumnSink&) = delete;
  virtual ~ColumnSink() = default;

  /// Error: DuplicateColumn, and whatever the sink's storage refuses.
  [[nodiscard]] virtual Status begin(const ColumnLayout& layout) = 0;
  /// Whole rows, row-major.
  [[nodiscard]] virtual Status rows(std::span<const double> values) = 0;
  /// The next values of one column.
  [[nodiscard]] virtual Status column(std::size_t index, std::span<const double> values) = 0;
  /// A sentence the user should read beside the result: what was skipped, renamed, assumed.
  virtual void note(std::string sentence) = 0;
};

/// A recording format, as a value.
struct Format {
  std::string_view name;         ///< as it appears in documents: `csv`, `npy`
  std::string_view description;  ///< for people: "comma-separated values"

  /// How sure `head` (the first bytes of the decompressed file, up to kSniffBytes) is of this format: 0 no, 100 certain
  /// (a magic number). The surest format decodes; one that is not certain yields to the signature of a foreign format.
  int (*sniff)(std::string_view head);

  /// Streams the samples of `source`, which stands at its first byte, into `sink`. Returns an error or has consumed the
  /// whole input. Polls `control.stop`. Never allocates from what a header claims.
  Status (*decode)(ByteSource& source, const DecodeLimits& limits, ColumnSink& sink, const RunControl& control);
};

/// Bytes a sniffer sees at most.
inline constexpr std::size_t kSniffBytes = std::size_t{64} * 1024;

/// Every registered format, once.
[[nodiscard]] std::span<const Format* const> all_formats();

/// The name of a format that driftlab knows but does not read, by its magic number: "a ZIP archive", "an HDF5 file".
[[nodiscard]] std::optional<std::string> recognise_foreign(std::string_view head);

/// What unreadable bytes look like, as the end of a sentence: "a ZIP archive", "a MATLAB 5 file", "semicolon-separated
/// text", "binary data".
[[nodiscard]] std::string describe_unknown(std::string_view head);

/// What came out of a file.
struct Decoded {
  std::string format;  ///< name of the format
  Compression compression = Compression::None;
  std::size_t rows = 0;
  ColumnNames names;
  bool has_header = false;
  std::vector<std::string> notes;
};

/// Decompresses (once: an archive inside an archive is refused), recognises and decodes `reader` into `sink`.
/// A cell that is no number is a missing sample (core/signal/missing.hpp), not an error: whoever needs the column
/// decides. Errors: EmptyInput, UnsupportedFormat (with what it looks like), those of make_decompressor, those of the
/// format:
///   csv  EmptyInput, NoSamples, RaggedRow, DuplicateColumn, LimitExceeded; where no cell is a number, what is wrong
///        with the first: NotANumber, NonFinite, OutOfRange
///   npy  Truncated (fewer bytes than the header declares), ShapeMismatch (more bytes, or an impossible shape),
///        UnsupportedType, NoSamples, LimitExceeded
/// and Io, Cancelled. Fields: `row` (in text the line of the file from 1, else the sample from 1), `column` (its name).
[[nodiscard]] Result<Decoded> decode_stream(std::unique_ptr<ByteReader> reader, ColumnSink& sink,
                                            const DecodeLimits& limits = {}, const RunControl& control = {});

/// Decodes the file `input` into a column file at `output`, which exists afterwards only on success, synced to disk.
/// Progress stage: "decode". Errors: those of decode_stream, NotFound, Io, DiskFull; field `path` is the bare file
/// name. O(bytes) time, flat memory.
[[nodiscard]] Result<Decoded> decode_file(const std::filesystem::path& input, const std::filesystem::path& output,
                                          const DecodeLimits& limits = {}, const RunControl& control = {});

}  // namespace driftlab
