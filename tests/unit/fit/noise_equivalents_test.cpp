#include "core/fit/noise_equivalents.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace driftlab {
namespace {

double value(const std::vector<NoiseEquivalent>& all, const std::string& convention, double si) {
  for (const NoiseEquivalent& one : all) {
    if (one.convention == convention) {
      return one.factor * si;
    }
  }
  return std::nan("");
}

TEST(NoiseEquivalents, DataSheetDensityAndAngleRandomWalkDifferByTheRootOfTwo) {
  // A published gyroscope: 0.05 deg/s/sqrt(Hz), one-sided, and 2.0 deg/sqrt(h): 0.05/sqrt(2) * 60 = 2.12.
  const auto all = white_noise_equivalents(Dimension::AngularRate, 0.01);
  const double si = 0.05 / std::numbers::sqrt2 * std::numbers::pi / 180.0;
  EXPECT_NEAR(value(all, "density_one_sided", si), 0.05, 1e-15);
  EXPECT_NEAR(value(all, "density_two_sided", si), 0.05 / std::numbers::sqrt2, 1e-15);
  EXPECT_NEAR(value(all, "ieee_952", si), 2.1213, 1e-4);
  EXPECT_NEAR(value(all, "kalibr_noise_density", si), si, 1e-18);
  EXPECT_NEAR(value(all, "per_sample", si), 0.05 / std::numbers::sqrt2 * 10.0, 1e-14);
}

TEST(NoiseEquivalents, AccelerometersAreInMicroG) {
  const auto all = white_noise_equivalents(Dimension::SpecificForce, 0.0025);
  EXPECT_NEAR(value(all, "density_two_sided", 9.80665e-4), 100.0, 1e-10);  // 100 ug/sqrt(Hz)
  EXPECT_NEAR(value(all, "ieee_952", 9.80665e-4), 9.80665e-4 * 60.0, 1e-12);
  EXPECT_NEAR(value(all, "per_sample", 9.80665e-4), 0.1 * 20.0, 1e-12);  // mg
}

TEST(NoiseEquivalents, WalkGrowsByTheRootOfTheInterval) {
  const auto all = random_walk_equivalents(Dimension::AngularRate, 0.01);
  EXPECT_NEAR(value(all, "step_per_sample", std::numbers::pi / 180.0), 0.1, 1e-15);
  EXPECT_NEAR(value(all, "kalibr_random_walk", 3e-5), 3e-5, 1e-20);
  EXPECT_NEAR(value(all, "ieee_952", 1.0), 180.0 / std::numbers::pi * 3600.0 * 60.0, 1e-3);
}

}  // namespace
}  // namespace driftlab
