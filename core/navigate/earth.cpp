#include "core/navigate/earth.hpp"

#include "core/signal/angle.hpp"

#include <GeographicLib/Geocentric.hpp>

#include <cmath>

namespace driftlab {
namespace {

/// Zonal coefficients of the normal field from J2 (Heiskanen and Moritz 1967, eq. 2-92).
constexpr double kJ2 = 1.082629821313e-3;

constexpr double zonal(int n) {
  const double e2 = kEarthEccentricity2;
  double power = 1.0;
  for (int k = 0; k < n; ++k) {
    power *= e2;
  }
  const double sign = n % 2 == 0 ? -1.0 : 1.0;
  return sign * 3.0 * power / ((2.0 * n + 1.0) * (2.0 * n + 3.0)) * (1.0 - n + 5.0 * n * kJ2 / e2);
}

constexpr double kJ4 = zonal(2);
constexpr double kJ6 = zonal(3);

const GeographicLib::Geocentric& ellipsoid() {
  static const GeographicLib::Geocentric shared(kEarthRadius, kEarthFlattening);
  return shared;
}

double curvature_root(double latitude_rad) {
  const double s = std::sin(latitude_rad);
  return std::sqrt(1.0 - kEarthEccentricity2 * s * s);
}

}  // namespace

double meridian_radius(double latitude_rad) {
  const double root = curvature_root(latitude_rad);
  return kEarthRadius * (1.0 - kEarthEccentricity2) / (root * root * root);
}

double prime_vertical_radius(double latitude_rad) { return kEarthRadius / curvature_root(latitude_rad); }

Vector3 to_ecef(const Geodetic& place) {
  Vector3 r;
  ellipsoid().Forward(place.latitude_rad / kDegree, place.longitude_rad / kDegree, place.height_m, r.x(), r.y(), r.z());
  return r;
}

Geodetic to_geodetic(const Vector3& ecef_m) {
  Geodetic place;
  ellipsoid().Reverse(ecef_m.x(), ecef_m.y(), ecef_m.z(), place.latitude_rad, place.longitude_rad, place.height_m);
  place.latitude_rad *= kDegree;
  place.longitude_rad *= kDegree;
  return place;
}

Matrix3 ned_axes(double latitude_rad, double longitude_rad) {
  const double sp = std::sin(latitude_rad);
  const double cp = std::cos(latitude_rad);
  const double sl = std::sin(longitude_rad);
  const double cl = std::cos(longitude_rad);
  Matrix3 axes;
  axes << -sp * cl, -sl, -cp * cl, -sp * sl, cl, -cp * sl, cp, 0.0, -sp;
  return axes;
}

Matrix3 ned_axes(const Vector3& ecef_m) {
  const Geodetic place = to_geodetic(ecef_m);
  return ned_axes(place.latitude_rad, place.longitude_rad);
}

Vector3 normal_gravity(const Vector3& ecef_m) {
  const double r2 = ecef_m.squaredNorm();
  const double inverse_r = 1.0 / std::sqrt(r2);
  const double s = ecef_m.z() * inverse_r;
  const double s2 = s * s;
  const double q2 = kEarthRadius * kEarthRadius * inverse_r * inverse_r;
  const double q4 = q2 * q2;
  const double q6 = q4 * q2;
  // Legendre polynomials and their slopes over s.
  const double p2 = 0.5 * (3.0 * s2 - 1.0);
  const double p4 = 0.125 * ((35.0 * s2 - 30.0) * s2 + 3.0);
  const double p6 = 0.0625 * (((231.0 * s2 - 315.0) * s2 + 105.0) * s2 - 5.0);
  const double d2 = 3.0;
  const double d4 = 0.5 * (35.0 * s2 - 15.0);
  const double d6 = 0.125 * ((693.0 * s2 - 630.0) * s2 + 105.0);
  const double radial = 1.0 - 3.0 * kJ2 * q2 * p2 - 5.0 * kJ4 * q4 * p4 - 7.0 * kJ6 * q6 * p6;
  const double slope = -(kJ2 * q2 * d2 + kJ4 * q4 * d4 + kJ6 * q6 * d6) * s;  // dU/ds over GM/r
  const double scale = kEarthGm * inverse_r * inverse_r;
  const double along_r = -scale * (radial + s * slope) * inverse_r;
  Vector3 gravity = along_r * ecef_m;
  gravity.z() += scale * slope;
  gravity.x() += kEarthRate * kEarthRate * ecef_m.x();
  gravity.y() += kEarthRate * kEarthRate * ecef_m.y();
  return gravity;
}

Matrix3 gravity_gradient(const Vector3& ecef_m) {
  const double r2 = ecef_m.squaredNorm();
  const double scale = kEarthGm / (r2 * std::sqrt(r2));
  Matrix3 gradient = (3.0 * scale / r2) * ecef_m * ecef_m.transpose() - scale * Matrix3::Identity();
  gradient(0, 0) += kEarthRate * kEarthRate;
  gradient(1, 1) += kEarthRate * kEarthRate;
  return gradient;
}

}  // namespace driftlab
