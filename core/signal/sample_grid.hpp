#pragma once
/// Where the rows of a recording with lost samples lie on the grid of its sampler. Internal to core/signal.
///
/// Model: row i is the sample of place p_i, p rising, and its stamp is t_0 + interval p_i + e_i. Steps between stamps
/// are then whole multiples of the interval but for the errors e (jitter, rounding, a late host). Interval: the mean of
/// the steps that are one interval long, then of ever more of them, each divided by the whole number it is nearest to.
/// Places: stamp/interval less the row number is a staircase that rises by what is lost, plus a phase that drifts with
/// the clocks and the errors. The phase is the circular mean over 256 rows; the staircase is the non-decreasing integer
/// sequence nearest to the rest in the sum of absolute deviations (isotonic regression in L1; Ahuja and Orlin 2001), so
/// that a late stamp which the next ones make up for is no loss.
///
/// Stamps on arrival, in bursts or rounded to a clock tick of about the interval, can look the same: their steps may be
/// whole multiples of something. They differ in that nothing is lost, so that long steps make up for short ones and the
/// time of many rows is known far better than independent steps would have it. Stamps of a busy host may wander about
/// the samples, each step off by a little and their sum by more than an interval. Neither have a grid here.
#include "core/signal/gappy_samples.hpp"

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace driftlab {

struct SampleGrid {
  double interval_s = 0.0;
  std::vector<Gap> gaps;  ///< rows before which samples are lost, and how many
};

/// `stamps` [s] of all rows, rising but at the rows `backward` (ascending), where they start anew; `steps`
/// those between them that do not fall, `typical_s` the median step. `stated_s` is the interval that the user states, 0
/// for none: where long steps make up for short ones, only a grid that agrees with it within 1 % is believed. Nothing
/// where the stamps lie on no grid, fewer than 100 are there, or more than seven tenths would be lost. O(rows log rows)
/// time, O(rows) memory.
[[nodiscard]] std::optional<SampleGrid> find_sample_grid(std::span<const double> stamps,
                                                         std::span<const std::size_t> backward,
                                                         std::span<const double> steps, double typical_s,
                                                         double stated_s);

/// The grid of a stated interval of which the median step is several, as where a logger drops nearly every second
/// sample. Only for stamps that are exact to a tenth of an interval or so, whose multiples have no common factor (of a
/// rate that is stated twice too high they have), and whose long steps are not made up for by short ones; at most three
/// fifths lost.
[[nodiscard]] std::optional<SampleGrid> find_stated_grid(std::span<const double> stamps,
                                                         std::span<const std::size_t> backward,
                                                         std::span<const double> steps, double typical_s,
                                                         double stated_s);

}  // namespace driftlab
