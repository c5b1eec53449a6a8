#pragma once
/// Least, greatest and mean values of a long recording at every zoom, kept beside its columns.
///
/// Level k holds one node for each 256 * 16^k samples: least, greatest, sum and count of the samples that are present.
/// A trace of any stretch is put together from the coarsest nodes that fit, so that 10^8 samples are shown from some
/// thousand nodes instead of 800 MB. The nodes take 1.7 % of the space of the columns.
///
/// The file is a column file (core/read/column_file.hpp) with four columns for each column of the recording, `i.low`,
/// `i.high`, `i.sum` and `i.present`, whose rows are the nodes of level 0, then those of level 1, and so on to the
/// level that has at most 16. It holds nothing that the columns do not: it may be missing, and is made again from them.
#include "core/read/column_file.hpp"
#include "core/signal/decimated_trace.hpp"

#include <filesystem>

namespace driftlab {

/// Rows from which a pyramid is worth its space: fewer are read in about 2 ms.
inline constexpr std::size_t kPyramidRows = std::size_t{1} << 20;

/// Writes the pyramid of `columns` to `path`, complete or not at all. `columns` has at most 1024 columns. One pass over
/// the samples, memory of the nodes of one column. Errors: those of ColumnFileWriter.
[[nodiscard]] Status write_trace_pyramid(const ColumnFile& columns, const std::filesystem::path& path);

/// A pyramid mapped read-only. Const use is thread safe.
class TracePyramid {
 public:
  /// Errors: those of ColumnFile::open; ShapeMismatch where it is not that of `columns`.
  [[nodiscard]] static Result<TracePyramid> open(const std::filesystem::path& path, const ColumnFile& columns);

  /// As decimated_trace of samples [first, first + count) of a column, with `most` >= 2: stretches are whole nodes, so
  /// that they begin at multiples of their length, and the first and the last are shorter. `TraceBucket::first` counts
  /// from the first of the column.
  [[nodiscard]] std::vector<TraceBucket> trace(const ColumnFile& columns, std::size_t column, std::size_t first,
                                               std::size_t count, std::size_t most) const;

 private:
  explicit TracePyramid(ColumnFile nodes) : nodes_(std::move(nodes)) {}
  ColumnFile nodes_;
};

/// Samples in one stretch of TracePyramid::trace, 0 where that many samples in that many stretches need no nodes: they
/// are fewer than kPyramidRows, or each stretch would be shorter than a node.
[[nodiscard]] std::size_t pyramid_stretch(std::size_t count, std::size_t most);

}  // namespace driftlab
