#pragma once
/// From time stamps to the uniform grid on which the samples were taken.
#include "core/investigate/study/study.hpp"

#include <span>
#include <vector>

namespace driftlab::investigate {

struct TimeGrid {
  double dt_s = 0.0;
  std::size_t length = 0;
  std::vector<std::size_t> place;  ///< grid place of each row, strictly rising; empty: row i is place i
  Stamps stamps;

  [[nodiscard]] std::size_t place_of(std::size_t row) const { return place.empty() ? row : place[row]; }
  /// The grid of the `rows` rows less `left_out` (ascending), whose places then hold none.
  void leave_out(std::span<const std::size_t> left_out, std::size_t rows);
};

/// Fits the grid to the stamps [s] of consecutive rows, which must not decrease. Lost samples are found as in every
/// recording (core/signal/spacing.hpp), which gives the interval too: a sensor that lost a fifth at random keeps its
/// rate. The sample interval is 1/`rate_hz` if a rate is stated and the stamps agree with it, else what they show.
/// Errors: NonFinite; NonMonotonicTime; InconsistentSampling (time never advances); LimitExceeded (a grid of more than
/// ten million points less than a third of which have samples).
///
/// Where more than a fifth of the steps are below a quarter of the mean step, samples arrive in bursts
/// (`Stamps::bursts`) and the stamps are those of the arrival: the rows are evenly spaced at the mean step, whatever
/// rate is stated. Larger steps than a quarter of the mean part the bursts.
[[nodiscard]] Result<TimeGrid> fit_time_grid(std::span<const double> stamps_s, std::optional<double> rate_hz);

}  // namespace driftlab::investigate
