#pragma once
/// What documents and figures draw of a drive on its map: its way, and where outages ended, with the ellipse that a
/// filter believes in, whether the truth lies in it, and how large an error is.
///
/// A filter that gives a covariance P of its horizontal error e says that e' P^-1 e (NEES) is chi-square distributed
/// with two degrees of freedom, whose quantile of a share p is -2 ln(1 - p). Outages are told apart by the ellipses of
/// 50 and 95 %: of many outages of a filter whose covariance is right, half lie in the first and one in twenty outside
/// both.
#include "core/navigate/drive/drive_outage.hpp"

#include <array>
#include <cstddef>
#include <optional>
#include <span>
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

/// The smallest of the filter's ellipses in which an outage ended.
enum class EllipseClass { Within50, Within95, Outside };
inline constexpr std::size_t kEllipseClasses = 3;

/// A NEES on the boundary of an ellipse counts as within it. An outage without a NEES (the filter's covariance is not
/// positive definite) lies outside.
[[nodiscard]] EllipseClass ellipse_class(const std::optional<double>& nees);

/// One outage as a document keeps it of a drive.
struct MappedOutage {
  MapPlace truth_m = {};                     ///< where it ended
  MapPlace error_m = {};                     ///< the filter's estimate minus that
  std::array<double, 3> covariance_m2 = {};  ///< {north, north-east, east} of the error, as the filter believes
  std::optional<double> nees;                ///< of the error under that covariance
};

/// On the map of `drive`, whose reference is not empty.
[[nodiscard]] MappedOutage mapped(const DriveOutage& outage, const Drive& drive);

/// The outages of one class.
struct MapClass {
  std::vector<MapPlace> truths_m;                ///< where they ended, one each
  std::vector<std::vector<MapPlace>> strokes_m;  ///< two each: from the truth to the estimate, and the 95 % ellipse
};

struct OutageMap {
  std::array<MapClass, kEllipseClasses> classes;  ///< by EllipseClass
  double largest_error_m = 0.0;

  [[nodiscard]] const MapClass& of(EllipseClass which) const { return classes[static_cast<std::size_t>(which)]; }
};

/// Sorts outages into classes, in the order given, and draws the ellipse of each about the filter's estimate. O(n).
[[nodiscard]] OutageMap map_of(std::span<const MappedOutage> outages);

/// The way of a drive for a map: every so many points of its reference, at most 501 and its last one among them. Empty
/// without a reference.
[[nodiscard]] std::vector<MapPlace> way_of(const Drive& drive);

}  // namespace driftlab::drive
