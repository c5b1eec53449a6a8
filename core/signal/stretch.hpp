#pragma once
/// The choice of the rows to analyse when some samples are missing.
///
/// Samples may be missing between two rows of a recording, either lost in transmission (a jump of the time column) or
/// because rows hold no measurement. They are not bridged by interpolation, nor is the rest discarded: one stretch with
/// gaps is analysed, in which only what touches a gap is lost (core/signal/gappy_samples.hpp). Up to a fifth of the
/// grid of a stretch may be missing, or three fifths if they are scattered: no gap is longer than a hundredth of the
/// rows. If more is missing, the stretch is split at its largest gap and the part with more rows is kept.
#include "core/signal/gappy_samples.hpp"

#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace driftlab {

/// The largest share of the grid points of an analysed stretch that may be missing.
inline constexpr double kMostMissing = 0.2;
inline constexpr double kMostScattered = 0.6;  ///< the same where no gap is longer than kScattered of the rows
inline constexpr double kScattered = 0.01;

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
  /// The gaps of the series formed by the runs laid end to end; rows are counted from its first.
  [[nodiscard]] std::vector<Gap> gaps() const;
  /// The run with the most rows, the earliest if several tie; empty without runs.
  [[nodiscard]] RowRun longest() const;
};

/// The stretch of consecutive `runs` to analyse. It never has fewer rows than the longest run. O(runs^2) at worst.
[[nodiscard]] Stretch choose_stretch(std::span<const RowRun> runs);

/// The rows [first, last) cut into runs at every gap inside (rows of the file, rising).
[[nodiscard]] std::vector<RowRun> cut_at_gaps(std::size_t first, std::size_t last, std::span<const Gap> gaps);

/// `runs` without the rows `removed` (ascending) and without [block.first, block.second). The removed rows count as
/// missing where rows on both sides remain.
[[nodiscard]] std::vector<RowRun> without_rows(std::span<const RowRun> runs, std::span<const std::size_t> removed,
                                               std::pair<std::size_t, std::size_t> block = {0, 0});

/// The rows common to both, cut where either has a gap. Grid points of `a` between two common rows count as missing.
[[nodiscard]] std::vector<RowRun> shared_runs(std::span<const RowRun> a, std::span<const RowRun> b);

}  // namespace driftlab
