#include "core/navigate/earth.hpp"

#include "core/navigate/attitude.hpp"

#include <GeographicLib/NormalGravity.hpp>
#include <gtest/gtest.h>

#include <numbers>

namespace driftlab {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

TEST(Earth, GravityIsThatOfTheLevelEllipsoid) {
  // The oracle is the closed form of the normal field; what is left out (J8 and above) is 9 x 1.4e-11 x 9.8 = 1e-9.
  const GeographicLib::NormalGravity& oracle = GeographicLib::NormalGravity::WGS84();
  for (double latitude = -90.0; latitude <= 90.0; latitude += 7.5) {
    for (const double height : {-400.0, 0.0, 1100.0, 20000.0}) {
      const Vector3 r = to_ecef({latitude * kDegree, 0.7, height});
      Vector3 expected;
      oracle.U(r.x(), r.y(), r.z(), expected.x(), expected.y(), expected.z());
      EXPECT_LT((normal_gravity(r) - expected).norm(), 2e-8) << latitude << " deg, " << height << " m";
    }
  }
}

TEST(Earth, GravityPointsDownOnTheEllipsoid) {
  for (const double latitude : {-80.0, -45.0, 0.0, 30.0, 51.0}) {
    const Geodetic place{latitude * kDegree, 1.0, 0.0};
    const Vector3 g = ned_axes(place.latitude_rad, place.longitude_rad).transpose() * normal_gravity(to_ecef(place));
    EXPECT_NEAR(g.x(), 0.0, 3e-8);
    EXPECT_NEAR(g.y(), 0.0, 1e-12);
    EXPECT_GT(g.z(), 9.78);
  }
}

TEST(Earth, GradientMatchesDifferencesOfGravity) {
  const Vector3 r = to_ecef({0.9, -2.0, 500.0});
  const Matrix3 gradient = gravity_gradient(r);
  for (Eigen::Index k = 0; k < 3; ++k) {
    const Vector3 step = 10.0 * Vector3::Unit(k);
    const Vector3 slope = (normal_gravity(r + step) - normal_gravity(r - step)) / 20.0;
    EXPECT_LT((gradient.col(k) - slope).norm(), 0.015 * gradient.norm());
  }
}

TEST(Earth, PlacesSurviveTheWayThroughEcef) {
  for (const double latitude : {-1.5, -0.3, 0.0, 0.8, 1.57}) {
    const Geodetic back = to_geodetic(to_ecef({latitude, -3.0, 8000.0}));
    EXPECT_NEAR(back.latitude_rad, latitude, 1e-15 + 1e-14);
    EXPECT_NEAR(back.longitude_rad, -3.0, 1e-12);  // a nanometre at 5 km from the pole
    EXPECT_NEAR(back.height_m, 8000.0, 1e-7);
  }
}

TEST(Earth, NorthEastDownIsARotation) {
  const Matrix3 axes = ned_axes(0.6, -2.2);
  EXPECT_LT((axes.transpose() * axes - Matrix3::Identity()).norm(), 1e-15);
  EXPECT_NEAR(axes.determinant(), 1.0, 1e-15);
  const Vector3 up = to_ecef({0.6, -2.2, 10.0}) - to_ecef({0.6, -2.2, 9.0});
  EXPECT_LT((up + axes.col(2)).norm(), 1e-8);
}

TEST(Earth, CurvatureIsTheRateOfPositionOverLatitude) {
  const double step = 1e-5;
  const Vector3 north = (to_ecef({0.7 + step, 0.0, 0.0}) - to_ecef({0.7 - step, 0.0, 0.0})) / (2.0 * step);
  EXPECT_NEAR(north.norm(), meridian_radius(0.7), 1e-3);
  const Vector3 east = (to_ecef({0.7, step, 0.0}) - to_ecef({0.7, -step, 0.0})) / (2.0 * step);
  EXPECT_NEAR(east.norm(), prime_vertical_radius(0.7) * std::cos(0.7), 1e-3);
}

TEST(Attitude, EulerAnglesSurviveTheQuaternion) {
  for (const double heading : {-3.0, -0.4, 0.0, 2.9}) {
    for (const double pitch : {-1.4, 0.0, 0.3}) {
      const EulerAngles back = to_euler(from_euler({0.2, pitch, heading}));
      EXPECT_NEAR(back.roll_rad, 0.2, 1e-14);
      EXPECT_NEAR(back.pitch_rad, pitch, 1e-14);
      EXPECT_NEAR(back.heading_rad, heading, 1e-14);
    }
  }
}

TEST(Attitude, RotationVectorAndQuaternionAreInverse) {
  // Both sides of 0.1 rad, where series and functions meet.
  for (const double angle : {0.0, 1e-9, 1e-3, 0.0999, 0.1001, 1.0, 3.1}) {
    const Vector3 phi = angle * Vector3(0.6, -0.48, 0.64);
    const Quaternion q = rotation(phi);
    EXPECT_NEAR(q.norm(), 1.0, 2e-16 * 4);
    EXPECT_LT((rotation_vector(q) - phi).norm(), 2e-15) << angle;
  }
}

}  // namespace
}  // namespace driftlab
