#pragma once
/// The bins of a profile along a quantity.
#include <cstddef>
#include <vector>

namespace driftlab::investigate {

/// Edges between the values where there are few of them, else of twelve bins with equal numbers of values
/// (spec/trust-notes.md, section 7). Empty: all are alike.
[[nodiscard]] std::vector<double> edges_of(std::vector<double> values);

/// The bin that x lies in; the outermost for what lies beyond.
[[nodiscard]] std::size_t bin_of(const std::vector<double>& edge, double x);

}  // namespace driftlab::investigate
