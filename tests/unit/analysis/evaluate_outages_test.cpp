#include "core/analysis/evaluate_outages.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace driftlab {
namespace {

TEST(ErrorEllipse, OfAKnownCovarianceHasItsAxesAndDirection) {
  // Standard deviations of 3 m along 30 deg from north over east and 1 m across.
  const double a = std::numbers::pi / 6.0;
  const double c = std::cos(a);
  const double s = std::sin(a);
  const PlaneCovariance p{9.0 * c * c + s * s, 9.0 * s * s + c * c, 8.0 * s * c};
  const ErrorEllipse half = error_ellipse(p, 0.5);
  // Half of a plane normal distribution lies within sqrt(2 ln 2) standard deviations.
  const double radius = std::sqrt(2.0 * std::numbers::ln2);
  EXPECT_NEAR(half.semi_major_m, 3.0 * radius, 1e-12);
  EXPECT_NEAR(half.semi_minor_m, radius, 1e-12);
  EXPECT_NEAR(half.azimuth_rad, a, 1e-12);
  const auto [told, most] = error_ellipses(p);
  EXPECT_EQ(told.fraction, 0.5);
  EXPECT_EQ(told.semi_major_m, half.semi_major_m);
  EXPECT_EQ(most.fraction, 0.95);
  EXPECT_NEAR(most.semi_major_m, 3.0 * std::sqrt(-2.0 * std::log(0.05)), 1e-12);
}

TEST(ErrorEllipse, OfARoundCloudIsACircle) {
  const ErrorEllipse circle = error_ellipse({4.0, 4.0, 0.0}, 0.5);
  EXPECT_DOUBLE_EQ(circle.semi_major_m, circle.semi_minor_m);
}

}  // namespace
}  // namespace driftlab
