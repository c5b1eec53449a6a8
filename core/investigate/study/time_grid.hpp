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

/// Stamps [s] of consecutive rows, not falling. The interval starts as 1/`rate_hz` where one is stated (else the median
/// step) and is then fitted. Where stamps scatter so much that two rows would share a place, rows are taken as
/// uniform: their number says more than their stamps.
[[nodiscard]] Result<TimeGrid> fit_time_grid(std::span<const double> stamps_s, std::optional<double> rate_hz);

}  // namespace driftlab::investigate
