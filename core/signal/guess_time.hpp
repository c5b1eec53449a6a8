#pragma once
/// A guess of the time column from its numbers, for files in which no column is stated to be the time.
#include "core/signal/recording.hpp"

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>

namespace driftlab {

/// A column that rises as a time does, though nothing calls it one or nothing says in which unit it is.
struct TimeGuess {
  std::string column;
  Unit unit;             ///< the first of s, ms, us, ns that gives a rate of 0.5 Hz to 50 kHz
  double rate_hz = 0.0;  ///< by the median step
};

/// The first column without a role, or of a time without a unit, that rises throughout and nine tenths of whose steps
/// differ from the median step by at most half of it; a column of row numbers does not qualify. Nothing if a column is
/// already the time. `column(i)` gives the samples of column i; the first 10,000 are looked at.
[[nodiscard]] std::optional<TimeGuess> guess_time(const ColumnNames& names,
                                                  std::span<const std::optional<ColumnRole>> roles,
                                                  const std::function<std::span<const double>(std::size_t)>& column);

}  // namespace driftlab
