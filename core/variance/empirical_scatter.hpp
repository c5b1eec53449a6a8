#pragma once
/// The scatter of the wavelet variances taken from the record itself, where the noise is not what the intervals assume.
///
/// variance_intervals() assumes linear noise with a spectrum that its dictionary can describe. A level that changes
/// (volatility clustering, GARCH), a resonance or a filter break that: the intervals then cover 36 to 91 %. This
/// function compares the variance of each estimate under that assumption with the one that the squared coefficients
/// show (square_projections.hpp, of B degrees of freedom), scale by scale where samples/m >= 100. Without a difference
/// nothing is changed, to the bit. Where the observed scatter is larger (chi-square test of each scale at 1 % over all
/// of them, 6 % of the model's scatter allowed for the dictionary), the observed scatter takes the place of the assumed
/// one at all of these scales, with the t quantile of its B degrees instead of the normal one.
///
/// B, the number of cosines on which the squared coefficients are projected, is 192, 96, 48, 24 or 12. It is at most
/// 0.12 samples/m: the fastest cosine then has a period of 17 m samples, over which squared coefficients, each of 2 m
/// samples, are no longer correlated. Of these values the largest is taken for which no smaller one gives a larger
/// scatter by more than 2.2 standard errors (Lepski's rule, one-sided): fewer cosines see slower changes of the level.
///
/// Across scales: a change of the noise level changes the variances of all scales by the same factor. The covariance
/// that this gives them is estimated from all pairs of scales two and more octaves apart, as the mean of their observed
/// covariance less that of the model. Where it exceeds 3 standard errors it is added at all scales, those included that
/// are too long to be observed.
///
/// Where the fourth moment of the samples does not exist (Student t of four and less degrees of freedom), no estimate
/// of the scatter is consistent: the intervals remain too narrow (tests/ACCURACY.md).
#include "core/signal/progress.hpp"
#include "core/variance/haar_covariance.hpp"
#include "core/variance/haar_variance.hpp"
#include "core/variance/variance_intervals.hpp"

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace driftlab {

struct EmpiricalScatter {
  bool departs = false;           ///< the record scatters more than assumed, and the intervals were replaced
  double p = 1.0;                 ///< of the test, over all observed scales
  std::vector<double> ratio;      ///< observed over assumed variance of each estimate; one entry per observed scale
  std::vector<std::size_t> used;  ///< B of each
  double largest_ratio = 1.0;
};

/// `samples` are those that `curve` was computed from, without gaps; `intervals` are those of the curve, in whatever
/// unit, and are changed only where `departs` is set. O(N) time, N/2 doubles of memory. Unchanged if a stop was
/// requested.
EmpiricalScatter observe_scatter(std::span<const double> samples, double pivot, const HaarVariance& curve,
                                 HaarCovariance& plan, VarianceIntervals& intervals, const RunControl& control = {});

/// What a reader of the intervals is told where the record scatters more than assumed.
[[nodiscard]] std::string departure_sentence(const EmpiricalScatter& scatter);

}  // namespace driftlab
