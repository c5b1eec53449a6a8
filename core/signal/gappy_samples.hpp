#pragma once
/// Samples on a uniform grid, some of which are missing.
///
/// Row r of a file is the sample of one instant; where the time column jumps, instants without a row lie between two
/// rows. Everything that needs equal steps (variances, state-space models) works on the grid, where a missing sample is
/// marked and its value never read; nothing is interpolated.
#include "core/signal/result.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace driftlab {

/// `missing` samples that should lie between row `row - 1` and row `row`.
struct Gap {
  std::size_t row = 0;
  std::size_t missing = 0;
  friend bool operator==(const Gap&, const Gap&) = default;
};

/// A series may lack this many samples for each that it has: three fifths of its grid, with room to spare.
inline constexpr std::size_t kMostMissingPerRow = 2;

struct GappySamples {
  std::vector<double> values;         ///< one per grid point; 0 where missing
  std::vector<std::uint8_t> missing;  ///< one per grid point: 1 where there is no sample; empty: none is missing

  [[nodiscard]] std::size_t size() const { return values.size(); }
  [[nodiscard]] bool is_missing(std::size_t t) const { return !missing.empty() && missing[t] != 0; }
  [[nodiscard]] std::size_t missing_count() const;
};

/// Lays `rows` on the grid. Gaps rise by row, 1 <= row < rows. Errors: InvalidArgument (gaps out of order or outside),
/// LimitExceeded (more than kMostMissingPerRow missing samples a row: that is no gappy recording but several). O(grid).
[[nodiscard]] Result<GappySamples> on_grid(std::span<const double> rows, std::span<const Gap> gaps);

}  // namespace driftlab
