#pragma once
/// How long the errors of a receiver's positions last, by the fixes alone, while the vehicle rests (spec/drives.md,
/// section 6: what tells lasting errors of positions apart).
///
/// Where nothing moves, a position is a constant plus its error. Over all rests of 20 s and more, with x_i the position
/// less its rest's mean and pairs of all three axes counted together,
///   r(lag) = mean of x_i . x_j over pairs that are `lag` apart / mean of x_i . x_i.
/// White errors have r = 0 from the next fix on, Gauss-Markov errors exp(-lag/tau).
///
/// Each rest's mean takes some of its errors with it: of a rest of length T, r is too small by about 2 tau/T (1 - r).
/// Errors that last longer than a rest do not show at all, so that a time found here is that of errors shorter than the
/// rests. The first and last second of a rest are left out, for the clocks of unit and receiver may differ.
#include "core/navigate/drive/drive.hpp"

#include <cstddef>
#include <optional>

namespace driftlab::drive {

struct RestCorrelation {
  std::size_t rests = 0;
  double seconds = 0.0;  ///< of rest, in all
  double after_1s = 0.0;
  /// The lag at which the correlation falls to 1/e [s]; nothing where it does not within half of the longest rest.
  std::optional<double> lasts_s;
};

/// Nothing where no rest is long enough, where fixes there are more than 1.25 s apart, and where they do not differ.
/// O(fixes at rest times lags).
[[nodiscard]] std::optional<RestCorrelation> rest_correlation(const Drive& drive);

}  // namespace driftlab::drive
