#pragma once
/// Axes and places that figures of several documents share.
#include "schema/figure/plot.hpp"

#include <cstddef>
#include <string>

namespace driftlab::figure {

/// Ratios on a logarithmic axis that ends as far below 1 as above it: at 1/limit and limit, limit > 1.
[[nodiscard]] Axis ratio_axis(std::string name, double limit);

/// Ticks of such an axis: 1 and round ratios on both sides that lie within the limit; between 1 and a small limit
/// `finer` ones where it is asked for.
[[nodiscard]] std::vector<double> ratio_ticks(double limit, bool finer = false);

/// `count` places 1, 2, ... with a tick at each.
[[nodiscard]] Axis places_axis(std::string name, std::size_t count);

/// What stands at one place side by side: member `index` of `count`, all of them within half a step about `place`.
[[nodiscard]] double beside(double place, std::size_t index, std::size_t count);

/// From just below zero to a little beyond the greatest value, with room for the mark at zero.
[[nodiscard]] Axis axis_about_zero(std::string name, double greatest);

/// From zero to a little beyond the greatest value.
[[nodiscard]] Axis axis_from_zero(std::string name, double greatest);

/// Along y all curves of a plot, those without intervals or marks too, with room of half as much again at both ends of
/// a logarithmic axis. Values that are not positive are passed over; without any the axis stays as it is.
void frame_by_curves(Plot& plot);

/// A map: one length for a unit of both linear axes, and all curves within them. About the middle of the curves, with
/// 4 % of the longer side as margin (0.04 where they are shorter than 1); the shorter side is widened, the height to at
/// least 0.4 of the width and the width to at least the height. A plot without a value stays as it is.
void frame_as_map(Plot& plot);

/// The greatest value or upper end of an interval of a series, and at least 0.
[[nodiscard]] double greatest_of(const Series& series);

/// The greatest x of a series that has one.
[[nodiscard]] double farthest_of(const Series& series);

}  // namespace driftlab::figure
