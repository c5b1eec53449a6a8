#pragma once
/// Which samples of a recording are lost: the places of its rows on the grid of the sampler. Internal to core/signal.
///
/// Model. Row i is the sample of place p_i, and p rises. Its stamp is t_0 + interval p_i + e_i, where e_i is jitter,
/// rounding or the delay of a late host. But for these errors the steps between stamps are whole multiples of the
/// interval.
///
/// Interval. It is the mean of the steps that are one interval long; then of those that are up to two, four and ever
/// more intervals long, each divided by the whole number it is nearest to.
///
/// Places. The stamp in intervals less the number of the row is a staircase that rises where samples are lost, plus a
/// phase that drifts with the clocks and the errors. The phase is the circular mean over 256 rows. The places are the
/// staircase of whole numbers, never falling, that lies nearest to the rest in the sum of absolute deviations (isotonic
/// regression in L1; Ahuja and Orlin 2001). A late stamp that the next ones make up for is thereby no loss.
///
/// Stamps on arrival, in bursts, or rounded to a clock tick of about the interval can look the same, for their steps
/// may be whole multiples of something. There, however, nothing is lost: long steps make up for short ones, and the
/// time of many rows is known far better than if the steps were independent. The stamps of a busy host may wander, each
/// step off by a little and the sum by more than an interval. Neither kind is given a grid here.
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

/// The grid of which the steps are best multiples.
///
/// `stamps` [s] are those of all rows. They rise but at the rows `backward` (ascending), where they start anew. `steps`
/// are the differences between neighbouring stamps that do not fall, and `typical_s` is their median. `stated_s` is the
/// interval that the user states, or 0. Where long steps make up for short ones, a grid is believed only if it agrees
/// with the stated interval within 1 %.
///
/// There is no grid if the stamps lie on none, if there are fewer than 100 rows, or if more than seven tenths of the
/// samples would be lost. O(rows log rows) time, O(rows) memory.
[[nodiscard]] std::optional<SampleGrid> find_sample_grid(std::span<const double> stamps,
                                                         std::span<const std::size_t> backward,
                                                         std::span<const double> steps, double typical_s,
                                                         double stated_s);

/// The grid of a stated interval that is shorter than the median step, as where a logger drops nearly every second
/// sample.
///
/// It is believed only of stamps that are exact to about a tenth of an interval and whose long steps are not made up
/// for by short ones. The multiples must have no common factor: they have one where a rate is stated twice too high. At
/// most three fifths of the samples may be lost.
[[nodiscard]] std::optional<SampleGrid> find_stated_grid(std::span<const double> stamps,
                                                         std::span<const std::size_t> backward,
                                                         std::span<const double> steps, double typical_s,
                                                         double stated_s);

}  // namespace driftlab
