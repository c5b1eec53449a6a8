#pragma once
/// Where outages ended, for a map: the ellipse that a filter believes in, and how large an error is.
#include <array>
#include <vector>

namespace driftlab::drive {

/// East and north of one place [m].
using MapPlace = std::array<double, 2>;

/// Squared normalised errors (NEES) of two dimensions that `share` of outages stay below where the filter knows itself:
/// -2 ln(1 - share), chi-square of two degrees of freedom.
[[nodiscard]] double nees_of_share(double share);

/// 32 corners, the first again at the end, of the ellipse about a place that holds 95 % of the errors of a covariance
/// {north, north-east, east} [m^2].
[[nodiscard]] std::vector<MapPlace> ellipse95(const MapPlace& centre, const std::array<double, 3>& covariance_m2);

/// The length of an error with these components [m].
[[nodiscard]] double horizontal_m(double north_m, double east_m);

}  // namespace driftlab::drive
