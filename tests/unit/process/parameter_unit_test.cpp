#include "core/process/parameter_unit.hpp"

#include "core/signal/angle.hpp"

#include <gtest/gtest.h>

namespace driftlab {
namespace {

TEST(ParameterFactor, ReadsTheUnitsOfTheLab) {
  const ParameterSpec n{.name = "N", .second_power_halves = 1};
  const ParameterSpec level{.name = "sigma"};
  const ParameterSpec k{.name = "K", .second_power_halves = -1};
  const ParameterSpec beta{.name = "beta", .channel_power = 0, .second_power_halves = -2};
  EXPECT_NEAR(*parameter_factor("deg/sqrt(h)", Dimension::AngularRate, n), kDegree / 60.0, 1e-18);
  EXPECT_NEAR(*parameter_factor("deg/s/sqrt(Hz)", Dimension::AngularRate, n), kDegree, 1e-15);
  EXPECT_NEAR(*parameter_factor("deg/h", Dimension::AngularRate, level), kDegree / 3600.0, 1e-18);
  EXPECT_NEAR(*parameter_factor("deg/h/sqrt(h)", Dimension::AngularRate, k), kDegree / 216000.0, 1e-18);
  EXPECT_NEAR(*parameter_factor("ug/sqrt(Hz)", Dimension::SpecificForce, n), 9.80665e-6, 1e-18);
  EXPECT_NEAR(*parameter_factor("m/s/sqrt(h)", Dimension::SpecificForce, n), 1.0 / 60.0, 1e-15);
  EXPECT_NEAR(*parameter_factor("mg", Dimension::SpecificForce, level), 9.80665e-3, 1e-15);
  EXPECT_NEAR(*parameter_factor("m/s^2", Dimension::SpecificForce, level), 1.0, 1e-15);
  EXPECT_NEAR(*parameter_factor("1/s", Dimension::AngularRate, beta), 1.0, 1e-15);
  EXPECT_EQ(parameter_factor("deg/h", Dimension::AngularRate, n).error().code, ErrorCode::UnitMismatch);
  EXPECT_EQ(parameter_factor("mg", Dimension::AngularRate, level).error().code, ErrorCode::UnitMismatch);
  EXPECT_EQ(parameter_factor("furlong", Dimension::AngularRate, level).error().code, ErrorCode::UnknownUnit);
}

}  // namespace
}  // namespace driftlab
