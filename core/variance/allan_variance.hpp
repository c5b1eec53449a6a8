#pragma once
/// Overlapping Allan variance at any averaging times.
///
/// AV(m dt) is the mean over t of ((mean of m samples) - (mean of the m samples before))^2 / 2 (NIST SP 1065 eq. 11).
/// It is twice the Haar wavelet variance of half length m, and it is defined for every whole m, not only for powers of
/// two.
#include "core/signal/progress.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace driftlab {

/// Variances [unit^2] at the half lengths `m`, which may stand in any order. Precondition: each m is at least 1 and 2 m
/// is at most the number of samples. All entries come from one set of prefix sums formed relative to `pivot`. The cost
/// is O(N) time per entry and one array of N doubles. The result is empty if a stop was requested through
/// `control.stop`, which is polled every 4,096 samples.
[[nodiscard]] std::vector<double> allan_variance(std::span<const double> samples, double pivot,
                                                 std::span<const std::size_t> m, const RunControl& control = {});

/// About `count` whole half lengths, evenly spaced in the logarithm from 1 to samples/2, without repeats.
[[nodiscard]] std::vector<std::size_t> log_spaced_half_lengths(std::size_t samples, std::size_t count);

}  // namespace driftlab
