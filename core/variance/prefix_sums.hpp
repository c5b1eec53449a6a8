#pragma once
/// Running sums of a series, from which the mean of any stretch is one subtraction.
#include <cstddef>
#include <memory>
#include <span>

namespace driftlab {

/// P_0 = 0, P_t = sum of the first t values of (sample - pivot): samples + 1 values. Block sums are carried with their
/// rounding error, so that P has the accuracy of its last bit; subtract the mean as `pivot` to keep P small. O(N).
[[nodiscard]] std::unique_ptr<double[]> prefix_sums(std::span<const double> samples, double pivot);

/// Sums of one block on top of `base` (with rounding error `carry`), both moved to the block's end; for callers that
/// consume a block while it is in cache.
void extend_prefix(std::span<const double> block, double pivot, double& base, double& carry, double* out);

}  // namespace driftlab
