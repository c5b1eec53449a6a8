#pragma once
/// Which rows are analysed where some are missing.
///
/// Between two rows of a recording samples may be missing: lost on the way (a jump of the time column), or rows that
/// hold no measurement. They are neither bridged by interpolation nor a reason to drop the rest: what is analysed is
/// one stretch with gaps, in which only what touches a gap is lost (core/signal/gappy_samples.hpp). A stretch may miss
/// up to a fifth of its grid; where more is missing it is split at its largest gap, and the part with more rows goes
/// on.
#include "core/signal/gappy_samples.hpp"

#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace driftlab {

/// Of the grid points of an analysed stretch at most this share is missing.
inline constexpr double kMostMissing = 0.2;

/// Rows [first, first + count) without a gap, and what is missing before them.
struct RowRun {
  std::size_t first = 0;
  std::size_t count = 0;
  std::size_t missing = 0;  ///< samples between the run before and this one; of the first run without meaning
  friend bool operator==(const RowRun&, const RowRun&) = default;
};

/// Runs in order of their rows, analysed as one series.
struct Stretch {
  std::vector<RowRun> runs;

  [[nodiscard]] std::size_t rows() const;
  [[nodiscard]] std::size_t missing() const;  ///< between the runs
  /// The gaps of the series that the runs make when laid end to end: rows count from its first.
  [[nodiscard]] std::vector<Gap> gaps() const;
  /// The run with the most rows, the earliest of equals; empty without runs.
  [[nodiscard]] RowRun longest() const;
};

/// The stretch of consecutive `runs` to analyse; never fewer rows than the longest run. O(runs^2) at worst.
[[nodiscard]] Stretch choose_stretch(std::span<const RowRun> runs);

/// The rows [first, last) cut into runs at every gap inside (rows of the file, rising).
[[nodiscard]] std::vector<RowRun> cut_at_gaps(std::size_t first, std::size_t last, std::span<const Gap> gaps);

/// What is left of `runs` without the rows `removed` (rising) and [block.first, block.second); these count as missing
/// where rows on both sides are left.
[[nodiscard]] std::vector<RowRun> without_rows(std::span<const RowRun> runs, std::span<const std::size_t> removed,
                                               std::pair<std::size_t, std::size_t> block = {0, 0});

/// The rows that are in both, cut where either is; what lies between two of them on the grid of `a` counts as missing.
[[nodiscard]] std::vector<RowRun> shared_runs(std::span<const RowRun> a, std::span<const RowRun> b);

}  // namespace driftlab
