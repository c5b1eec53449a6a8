#pragma once
/// Overlapping Allan variance at any averaging times.
///
/// AV(m dt) = mean over t of ((mean of m samples) - (mean of the m before))^2 / 2 (NIST SP 1065 eq. 11): twice the Haar
/// wavelet variance of half length m, for any whole m and not only powers of two.
#include "core/signal/progress.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace driftlab {

/// Variances [unit^2] at half lengths `m` (each at least 1 and 2 m <= samples: a broken precondition otherwise), in any
/// order, from one set of prefix sums about `pivot`. O(N) per entry; one array of N doubles. Empty where control.stop
/// asked, which is polled every 4,096 samples.
[[nodiscard]] std::vector<double> allan_variance(std::span<const double> samples, double pivot,
                                                 std::span<const std::size_t> m, const RunControl& control = {});

/// About `count` whole half lengths, evenly spaced in the logarithm from 1 to samples/2, without repeats.
[[nodiscard]] std::vector<std::size_t> log_spaced_half_lengths(std::size_t samples, std::size_t count);

}  // namespace driftlab
