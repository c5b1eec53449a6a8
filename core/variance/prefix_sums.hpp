#pragma once
/// Running sums of a series, from which the mean of any stretch is one subtraction.
#include "core/signal/progress.hpp"

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace driftlab {

/// P_0 = 0 and P_t = sum of the first t values of (sample - pivot): samples + 1 values in all. The rounding error of
/// each block sum is carried along, so that P is accurate to its last bit; pass the mean as `pivot` to keep P small.
/// O(N). Null if a stop was requested through `control.stop`, which is polled every million samples.
[[nodiscard]] std::unique_ptr<double[]> prefix_sums(std::span<const double> samples, double pivot,
                                                    const RunControl& control = {});

/// Adds to a sum the squares of a filter of prefix sums whose outputs end at now[0] .. now[count - 1].
using FilterPower = double (*)(const double* now, std::size_t m, std::size_t count);

/// The sum over all t of the squared outputs of a filter that reaches back `spans` m samples, one sum for each entry of
/// `m`. Precondition: each m is at least 1 and spans m is at most the number of samples. The work goes block by block,
/// so that the newest prefix sums stay in the cache for all m. Empty if a stop was requested through `control.stop`.
[[nodiscard]] std::vector<double> filter_powers(std::span<const double> samples, double pivot,
                                                std::span<const std::size_t> m, std::size_t spans, FilterPower power,
                                                const RunControl& control);

/// Prefix sums of one block, starting from `base` with rounding error `carry`; both are moved on to the end of the
/// block. For callers that use a block while it is in the cache.
void extend_prefix(std::span<const double> block, double pivot, double& base, double& carry, double* out);

}  // namespace driftlab
