#pragma once
/// Total variance: the Allan variance of the record continued by reflection at both ends, which gives the longest
/// averaging times more degrees of freedom.
///
/// With x the running sum of the samples (N + 1 phases), continued by x*(-j) = 2 x(0) - x(j) and likewise at the end,
///   TOTVAR(m dt) = 1/(2 m^2 (N - 1)) sum over the N - 1 inner phases of (x*(i - m) - 2 x*(i) + x*(i + m))^2
/// (Greenhall, Howe and Percival 1999; NIST SP 1065 eq. 25). The reflection keeps a constant offset and does not see a
/// trend. It is biased where the noise is redder than white: see long_tau.hpp.
#include <cstddef>
#include <span>
#include <vector>

namespace driftlab {

/// Total variances [unit^2], not corrected, at the half lengths `m`, with sums formed relative to `pivot`.
/// Preconditions: `samples` hold at least 2 values, free of NaN and bounded; 1 <= m <= N - 1. O(N) time per entry and
/// one array of N doubles.
[[nodiscard]] std::vector<double> total_variance(std::span<const double> samples, double pivot,
                                                 std::span<const std::size_t> m);

}  // namespace driftlab
