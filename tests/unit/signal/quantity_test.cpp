#include "core/signal/quantity.hpp"

#include <gmock/gmock.h>

namespace driftlab {
namespace {

TEST(Quantity, ReadsEveryNameItWrites) {
  for (const Quantity quantity : all_quantities()) {
    EXPECT_EQ(parse_quantity(name_of(quantity)), quantity);
  }
  EXPECT_EQ(all_quantities().size(), 14U);
}

TEST(Quantity, NamesTheUnknownAndTheKnown) {
  const auto quantity = parse_quantity("acceleration");
  ASSERT_FALSE(quantity);
  EXPECT_EQ(quantity.error().code, ErrorCode::UnknownQuantity);
  EXPECT_THAT(quantity.error().message, ::testing::HasSubstr("specific_force"));
}

TEST(Quantity, IsMeasuredByItsOwnUnitsAndByTheUnstatedOne) {
  const auto unit = [](const char* symbol) { return *parse_unit(symbol); };
  for (const Quantity quantity : all_quantities()) {
    EXPECT_TRUE(measures(unit("1"), quantity));
    EXPECT_EQ(measures(unit("deg/s"), quantity), quantity == Quantity::Unspecified ||
                                                     quantity == Quantity::AngularRate ||
                                                     quantity == Quantity::ReferenceAngularRate)
        << name_of(quantity);
  }
  EXPECT_TRUE(measures(unit("deg"), Quantity::GnssPosition));
  EXPECT_TRUE(measures(unit("m"), Quantity::GnssPosition));
  EXPECT_FALSE(measures(unit("m"), Quantity::GnssVelocity));
}

TEST(Quantity, HasTheAxesOfItsKind) {
  EXPECT_TRUE(is_axis_of("x", Quantity::AngularRate));
  EXPECT_FALSE(is_axis_of("north", Quantity::AngularRate));
  EXPECT_TRUE(is_axis_of("north", Quantity::GnssVelocity));
  EXPECT_FALSE(is_axis_of("lat", Quantity::GnssVelocity));
  EXPECT_TRUE(is_axis_of("lat", Quantity::GnssPosition));
  EXPECT_TRUE(is_axis_of("yaw", Quantity::ReferenceAttitude));
  EXPECT_FALSE(is_axis_of("x", Quantity::Time));
}

TEST(Quantity, PairsSensorsWithQuantities) {
  for (const Quantity quantity : all_quantities()) {
    if (is_sensor(quantity)) {
      EXPECT_EQ(quantity_of_sensor(sensor_of(quantity)), quantity);
    }
  }
  EXPECT_EQ(quantity_of_sensor("barometer").error().code, ErrorCode::UnknownQuantity);
}

}  // namespace
}  // namespace driftlab
