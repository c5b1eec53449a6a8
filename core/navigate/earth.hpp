#pragma once
/// The Earth model of the World Geodetic System 1984: ellipsoid, rotation, normal gravity.
///
/// Frames: e is Earth-centred and Earth-fixed (x through the equator at longitude 0, z along the axis); n is
/// north-east-down at a place on the ellipsoid; b is the body, forward-right-down. Mechanisation and filter work in e,
/// where no trigonometric function of latitude is needed and the poles are not singular. Results for people are given
/// in n.
///
/// Latitude always means geodetic latitude. Conversions are those of GeographicLib (Karney 2011), accurate to
/// nanometres.
#include <Eigen/Core>

namespace driftlab {

using Vector3 = Eigen::Vector3d;
using Matrix3 = Eigen::Matrix3d;

/// Defining parameters of WGS-84 (NIMA TR8350.2, Table 3.1).
inline constexpr double kEarthRadius = 6378137.0;  ///< semi-major axis [m]
inline constexpr double kEarthFlattening = 1.0 / 298.257223563;
inline constexpr double kEarthGm = 3.986004418e14;  ///< [m^3/s^2]
inline constexpr double kEarthRate = 7.292115e-5;   ///< [rad/s]
inline constexpr double kEarthEccentricity2 = kEarthFlattening * (2.0 - kEarthFlattening);

/// A place: radians and metres above the ellipsoid.
struct Geodetic {
  double latitude_rad = 0.0;
  double longitude_rad = 0.0;
  double height_m = 0.0;
};

/// Radius of curvature in the meridian [m] at a geodetic latitude.
[[nodiscard]] double meridian_radius(double latitude_rad);
/// Radius of curvature in the prime vertical [m].
[[nodiscard]] double prime_vertical_radius(double latitude_rad);

[[nodiscard]] Vector3 to_ecef(const Geodetic& place);
[[nodiscard]] Geodetic to_geodetic(const Vector3& ecef_m);

/// Rotation n -> e at a place: its columns are north, east and down in e.
[[nodiscard]] Matrix3 ned_axes(double latitude_rad, double longitude_rad);
/// The same at a point given in e.
[[nodiscard]] Matrix3 ned_axes(const Vector3& ecef_m);

/// Normal gravity [m/s^2] in e: attraction of the level ellipsoid plus the centrifugal acceleration.
///
/// It uses the zonal harmonics J2, J4, J6 of the normal field (Heiskanen and Moritz 1967, eq. 2-92); the neglected
/// terms are below 2e-8 m/s^2 up to 20 km of height. It takes fifty multiplications and no trigonometric function.
[[nodiscard]] Vector3 normal_gravity(const Vector3& ecef_m);

/// d gravity / d position [1/s^2], symmetric: that of a point mass plus the centrifugal part, right to 1.5 %. The
/// filter needs it for the growth of vertical errors only.
[[nodiscard]] Matrix3 gravity_gradient(const Vector3& ecef_m);

/// [w x], the matrix of the cross product.
[[nodiscard]] inline Matrix3 cross_matrix(const Vector3& w) {
  Matrix3 matrix;
  matrix << 0.0, -w.z(), w.y(), w.z(), 0.0, -w.x(), -w.y(), w.x(), 0.0;
  return matrix;
}

/// Earth rotation in e [rad/s].
[[nodiscard]] inline Vector3 earth_rate() { return {0.0, 0.0, kEarthRate}; }

}  // namespace driftlab
