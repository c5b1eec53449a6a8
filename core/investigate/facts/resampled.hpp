#pragma once
/// Samples that a driver has made out of others: interpolated between fewer, or means over several.
///
/// Interpolated. Between samples m apart all others lie on the chord, to the last digit that the file writes; of noise
/// they never do. The largest m from 2 to 10, and its phase, at which more than 95 % of the samples between are within
/// one digit is a fact, if the noise is more than three digits.
///
/// Averaged. The running mean of m samples multiplies the spectrum by
///   sin^2(m w/2) / (m^2 sin^2(w/2)),   w = 2 pi f dt,
/// which is zero at every multiple of 1/(m dt). It is a fact if the power about every zero is below 2 % of that midway
/// between zeros, and in the ratio of the shape to it within a factor of 2, what the rounding adds taken off, and if
/// the power on the flank of every zero is in that ratio too. A low-pass of another shape fails on the flank: one of
/// second order has its zero at 1/(2 dt) as well, where what leaks from lower frequencies fills it.
#include <cstddef>
#include <span>

namespace driftlab::investigate {

struct Interpolation {
  std::size_t every = 0;  ///< m: one sample of so many was recorded; 0: not interpolated
  std::size_t phase = 0;  ///< row of the first that was
};
/// `digit`: the last digit that the file writes [unit of the rows]; 0: not known. O(n) where nothing is found.
[[nodiscard]] Interpolation find_interpolation(std::span<const double> rows, double digit);

/// m of a running mean of m samples; 0: none. `error`: on an even grid; `digit`: of the same unit, the step to which it
/// was rounded.
[[nodiscard]] std::size_t find_running_mean(std::span<const double> error, double digit);

}  // namespace driftlab::investigate
