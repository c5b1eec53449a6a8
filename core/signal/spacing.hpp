#pragma once
/// The spacing of time stamps: where samples are missing, and how evenly the rest lie.
///
/// Stamps can be read in four ways, which are tried in this order:
/// - Samples at the stated rate, most of which are lost: the stated rate is a whole multiple of the rate that the
///   median step shows.
/// - Samples of an even sampler, some of which are lost: the steps are whole multiples of its interval
///   (core/signal/sample_grid.hpp).
/// - Stamps on arrival, in bursts: more than 2 % of the steps look like gaps, though no grid fits. The samples are then
///   evenly spaced by their mean step, and only a step far longer than all others is a gap.
/// - Otherwise every step is judged by itself. It is a gap if it exceeds 1.5 intervals, and what it lacks follows from
///   the rows on both sides (core/signal/gap_sizes.hpp).
#include "core/signal/gappy_samples.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace driftlab {

struct Spacing {
  std::vector<std::size_t> long_steps;  ///< rows before which a step exceeds what the samples beside it span
  std::vector<Gap> gaps;                ///< samples missing at these steps; a step before a late stamp misses none
  std::size_t repeated_stamps = 0;
  double interval_s = 0.0;  ///< median of step per sample; 0 if the clock does not advance
  double jitter_s = 0.0;    ///< half the distance of the 5 % and 95 % quantiles of the steps that miss no sample
  bool bursts = false;
};

/// `stamps` [s] of all rows; `backward`: the rows, ascending, at which the clock goes back and starts again.
/// `stated_s`: the interval that the user states, 0 for none. O(rows log rows) where there are gaps, else O(rows).
[[nodiscard]] Spacing find_spacing(std::span<const double> stamps, std::span<const std::size_t> backward,
                                   double stated_s);

}  // namespace driftlab
