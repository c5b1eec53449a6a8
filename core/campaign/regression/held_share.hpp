#pragma once
/// How many samples were held over from the one before, where rounding makes equal neighbours too.
///
/// A driver that hands a sample out twice, or a bus that loses one, leaves neighbours that are equal. So does rounding:
/// of white noise of standard deviation sigma in steps q a share of about q / (2 sigma sqrt(pi)) of the samples equals
/// the one before (from sigma of half a step on), 35 % at sigma = 0.8 q; it moves with the level of the noise, with its
/// filter, and below half a step with where the mean lies between two steps. None of that is a lost sample.
///
/// With D the mean square of the differences of neighbours, of which a share h are zero because the sample was held,
/// and p(D/q^2) the share of equal neighbours that rounding makes of differences of that size, the share that is seen
/// is
///
///     r = h + (1 - h) p(D / ((1 - h) q^2)).                                                                        (1)
///
/// p is known exactly for two kinds of noise: Gaussian differences at every place between two steps (filtered noise),
/// and white Gaussian noise about a mean at a fixed place. Which of them it is nobody knows, so that p, and with it h,
/// has a lower and an upper bound: over both kinds, the places, four standard errors of the share (neighbours of one
/// difference counted as dependent), and a tenth of p for noise that is not Gaussian.
#include <cstddef>

namespace driftlab::regression {

struct HeldShare {
  double low = 0.0;
  double high = 0.0;
};

/// The bounds of h. `equal`: the share r of the `samples` samples; `mean_square`: D [unit^2]; `step`: q [unit], 0 where
/// the values lie on no lattice: then both bounds are r.
[[nodiscard]] HeldShare held_share(double equal, std::size_t samples, double mean_square, double step);

}  // namespace driftlab::regression
