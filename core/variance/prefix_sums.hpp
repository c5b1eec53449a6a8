#pragma once
/// Running sums of a series, from which the mean of any stretch is one subtraction.
#include "core/signal/progress.hpp"

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace driftlab {

/// P_0 = 0, P_t = sum of the first t values of (sample - pivot): samples + 1 values. Block sums are carried with their
/// rounding error, so that P has the accuracy of its last bit; subtract the mean as `pivot` to keep P small. O(N). Null
/// where `control.stop` asked, which is polled every million samples.
[[nodiscard]] std::unique_ptr<double[]> prefix_sums(std::span<const double> samples, double pivot,
                                                    const RunControl& control = {});

/// Adds to a sum the squares of a filter of prefix sums whose outputs end at now[0] .. now[count - 1].
using FilterPower = double (*)(const double* now, std::size_t m, std::size_t count);

/// The sum over all t of the squares of a filter that reaches back `spans` m samples, one for each of `m` (each at
/// least 1 and spans m <= samples: a broken precondition otherwise): block by block, so that the newest prefix sums
/// stay in cache for all m. Empty where `control.stop` asked.
[[nodiscard]] std::vector<double> filter_powers(std::span<const double> samples, double pivot,
                                                std::span<const std::size_t> m, std::size_t spans, FilterPower power,
                                                const RunControl& control);

/// Sums of one block on top of `base` (with rounding error `carry`), both moved to the block's end; for callers that
/// consume a block while it is in cache.
void extend_prefix(std::span<const double> block, double pivot, double& base, double& carry, double* out);

}  // namespace driftlab
