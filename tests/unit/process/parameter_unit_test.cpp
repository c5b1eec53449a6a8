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

TEST(ParameterUnit, MeasuresASensorOrItsDrift) {
  const auto unit = [](const char* symbol) { return *parse_parameter_unit(symbol); };
  EXPECT_TRUE(measures(unit("deg/h"), Quantity::AngularRate, 0));
  EXPECT_FALSE(measures(unit("deg/h"), Quantity::AngularRate, 1));
  EXPECT_TRUE(measures(unit("deg/s/h"), Quantity::AngularRate, 1));
  EXPECT_TRUE(measures(unit("mg"), Quantity::SpecificForce, 0));
  EXPECT_TRUE(measures(unit("mg/s"), Quantity::SpecificForce, 1));
  EXPECT_FALSE(measures(unit("mg"), Quantity::AngularRate, 0));
  EXPECT_TRUE(measures(unit("s"), Quantity::Unspecified, 0));
}

}  // namespace
}  // namespace driftlab
