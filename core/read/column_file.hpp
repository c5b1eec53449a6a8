#pragma once
/// A table of float64 columns on disk, written as a stream and read by mapping it into memory.
///
/// Every recording is decoded once into such a file; every analysis after that maps it and sees each channel as one
/// contiguous span, without a parse, a copy or an allocation. Values are stored as they came, in the file's own units.
///
/// Layout, little-endian, version 1:
///
///   offset  bytes  content
///        0      8  magic 89 44 4C 43 4F 4C 0D 0A ("\x89" "DLCOL" CR LF: text-mode damage shows at once)
///        8      4  u32 version = 1
///       12      4  u32 columns C, 1..65535
///       16      8  u64 rows N
///       24      8  u64 stride S: bytes from one column to the next = N*8 rounded up to a multiple of 64
///       32      8  u64 data offset D: a multiple of 64
///       40      8  u64 bytes of names B
///       48      8  u64 size of the file = D + C*S
///       56      8  u64 FNV-1a (64 bit) of bytes 0..55 and of the names
///       64      B  names: for each column u32 length, then that many bytes of UTF-8
///     64+B         zeros up to D = 64+B rounded up to a multiple of 64
///      D+i*S  N*8  column i: N float64 (IEEE 754), then zeros up to S
///
/// The checksum covers what decides where memory is read; the samples are guarded by the file size. A file that shrinks
/// while it is mapped cannot be guarded against (the kernel raises SIGBUS), so a finished file is never written again.
#include "core/signal/recording.hpp"
#include "core/signal/result.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace driftlab {

/// Writes a column file. Memory is flat: one buffer per column, 16 MiB together at most, and 24 bytes per buffer
/// spilled.
///
/// Samples go to an unnamed spool file in the directory of the target and are put in column order by finish(), so the
/// disk holds the table twice for that moment. The target appears under its name complete or not at all: a writer that
/// is destroyed, or whose process is killed, leaves nothing under it.
/// Not thread safe. Cost: each value is written twice.
class ColumnFileWriter {
 public:
  /// Starts a table that will appear at `path`; its directory must exist. A file already there is replaced by finish().
  /// Errors: InvalidArgument (no columns, more than 65535), DuplicateColumn, Io, DiskFull.
  [[nodiscard]] static Result<ColumnFileWriter> create(const std::filesystem::path& path, ColumnNames names);

  ColumnFileWriter(ColumnFileWriter&&) noexcept;
  ColumnFileWriter& operator=(ColumnFileWriter&&) noexcept;
  ColumnFileWriter(const ColumnFileWriter&) = delete;
  ColumnFileWriter& operator=(const ColumnFileWriter&) = delete;
  ~ColumnFileWriter();

  /// Appends whole rows: `values` is row-major and holds a multiple of the number of columns.
  /// Errors: Io, DiskFull; after an error only destruction is meaningful.
  [[nodiscard]] Status append_rows(std::span<const double> values);

  /// Appends to one column; columns may grow at different times but must be equally long at finish().
  [[nodiscard]] Status append_column(std::size_t column, std::span<const double> values);

  /// Writes header and columns, syncs the file to the disk and gives it its name. The caller syncs the directory where
  /// the *name* has to survive a power loss. Returns the number of rows.
  /// Errors: ShapeMismatch (columns of unequal length), Io, DiskFull.
  [[nodiscard]] Result<std::size_t> finish();

 private:
  struct State;
  explicit ColumnFileWriter(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

/// A column file mapped read-only. Move-only; spans stay valid as long as the object lives. Const use is thread safe.
class ColumnFile {
 public:
  /// Errors: NotFound, Io, Truncated (shorter than its header says), ShapeMismatch (header and size disagree),
  /// UnsupportedFormat (not a column file, or another version).
  [[nodiscard]] static Result<ColumnFile> open(const std::filesystem::path& path);

  ColumnFile(ColumnFile&& other) noexcept;
  ColumnFile& operator=(ColumnFile&& other) noexcept;
  ColumnFile(const ColumnFile&) = delete;
  ColumnFile& operator=(const ColumnFile&) = delete;
  ~ColumnFile();

  [[nodiscard]] std::size_t rows() const { return rows_; }
  [[nodiscard]] const ColumnNames& names() const { return names_; }

  /// Column `i` < names().size(), in the file's own unit: rows() values, the first at an address divisible by 64.
  [[nodiscard]] std::span<const double> column(std::size_t i) const;

  /// Lets the pages of these samples go; they are mapped again when they are read again. Changes nothing but memory.
  void release(std::span<const double> samples) const;

 private:
  ColumnFile() = default;
  const std::byte* base_ = nullptr;
  std::size_t size_ = 0;
  std::size_t rows_ = 0;
  std::size_t stride_ = 0;
  std::size_t data_offset_ = 0;
  ColumnNames names_;
};

}  // namespace driftlab
