#pragma once
/// Axes and places that figures of several documents share.
#include "schema/figure/plot.hpp"

#include <cstddef>
#include <string>

namespace driftlab::figure {

/// Ratios on a logarithmic axis that ends as far below 1 as above it: at 1/limit and limit, limit > 1.
[[nodiscard]] Axis ratio_axis(std::string name, double limit);

/// `count` places 1, 2, ... with a tick at each.
[[nodiscard]] Axis places_axis(std::string name, std::size_t count);

/// What stands at one place side by side: member `index` of `count`, all of them within half a step about `place`.
[[nodiscard]] double beside(double place, std::size_t index, std::size_t count);

/// From just below zero to a little beyond the greatest value, with room for the mark at zero.
[[nodiscard]] Axis axis_about_zero(std::string name, double greatest);

/// From zero to a little beyond the greatest value.
[[nodiscard]] Axis axis_from_zero(std::string name, double greatest);

}  // namespace driftlab::figure
