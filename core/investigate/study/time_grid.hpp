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
};

/// Fits the grid to the stamps [s] of consecutive rows, which must not decrease. The sample interval starts as
/// 1/`rate_hz` if a rate is stated, else as the median step, and is then fitted. If stamps scatter so much that two
/// rows would share a place, the rows are taken as evenly spaced, because their number is then more reliable than their
/// stamps.
///
/// Where more than a fifth of the steps are below a quarter of the mean step, samples arrive in bursts
/// (`Stamps::bursts`) and the stamps are those of the arrival: the rows are evenly spaced at the mean step, whatever
/// rate is stated. Larger steps than a quarter of the mean part the bursts.
[[nodiscard]] Result<TimeGrid> fit_time_grid(std::span<const double> stamps_s, std::optional<double> rate_hz);

}  // namespace driftlab::investigate
