#include "core/datasheet/data_sheet.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

namespace driftlab {
namespace {

TEST(SheetsNamedIn, KnowsOrderCodesFromOtherSensors) {
  ASSERT_EQ(sheets_named_in("LSM6DSOTR").size(), 1U);
  EXPECT_EQ(sheets_named_in("LSM6DSOTR").front()->name, "LSM6DSO");
  EXPECT_EQ(sheets_named_in("lsm6dsox").front()->name, "LSM6DSOX");
  EXPECT_EQ(sheets_named_in("ADIS16465-2BMLZ").front()->name, "ADIS16465-2");
  EXPECT_EQ(sheets_named_in("adis_16405_imu1").front()->name, "ADIS16405");
  EXPECT_TRUE(sheets_named_in("LSM6DSO32").empty()) << "a sensor of 32 g with a data sheet of its own";
  EXPECT_EQ(sheets_named_in("LSM6DS3TR-C").front()->name, "LSM6DS3TR-C");
  EXPECT_TRUE(sheets_named_in("phone-07").empty());
  EXPECT_TRUE(sheets_named_in("").empty());
}

TEST(SheetsNamedIn, GivesAFirstMtiTheFullScaleOfItsOwnCode) {
  const auto limit = [](std::string_view name) {
    const auto found = sheets_named_in(name);
    return found.size() == 1 ? found.front()->find(Quantity::SpecificForce)->scales.back().limit : 0.0;
  };
  EXPECT_EQ(limit("Xsens MTi-28A53G35"), 50.0);
  EXPECT_EQ(limit("MTi-28A53G35-2"), 50.0);
  EXPECT_EQ(limit("MTi-28A33G35"), 17.0);
  for (const char* const other : {"MTi-28", "MTi-28A", "MTi-28A83G25", "MTx-28A53G25"}) {
    EXPECT_TRUE(sheets_named_in(other).empty()) << other << ": its full scales stand in no sheet here";
  }
  EXPECT_NE(find_data_sheet("MTi-28").error().message.find("begin so: MTi-28A53G35, MTi-28A33G35."), std::string::npos);
}

TEST(SheetsNamedIn, KnowsTheSixHundredsWithTheirLetters) {
  for (const char* const name : {"MTi-630R", "MTi-680G", "mti 670g", "MTi-610R-2A8G4", "MTi-630-AHRS"}) {
    const auto found = sheets_named_in(name);
    ASSERT_EQ(found.size(), 1U) << name;
    EXPECT_EQ(found.front()->name, "MTi 600-series") << name;
  }
  EXPECT_TRUE(sheets_named_in("MTi-6301").empty());
}

TEST(KnownSensor, TakesTheOneOfTheQuantityWhereADeviceHasTwoChips) {
  const std::array<std::string, 1> phone{"GT-I9100 (L3G4200D, BMA220)"};
  EXPECT_EQ(known_sensor(phone, Quantity::AngularRate)->sheet->name, "L3G4200D");
  EXPECT_EQ(known_sensor(phone, Quantity::SpecificForce)->sheet->name, "BMA220");
  const std::array<std::string, 1> two{"BMI088 or ICM-42688-P"};
  EXPECT_FALSE(known_sensor(two, Quantity::AngularRate)) << "which of the two it is nobody knows";
}

TEST(KnownSensor, LetsTheMostTellingTextDecide) {
  const std::array<std::string, 3> texts{"", "board with MPU-6050", "bench BMI160"};
  EXPECT_EQ(known_sensor(texts, Quantity::AngularRate)->sheet->name, "MPU-6050");
}

TEST(StatedDensity, IsTwoSidedWhicheverFigureStandsInTheSheet) {
  const double degree = std::numbers::pi / 180.0;
  const SensorSheet& mpu = *find_data_sheet("MPU-6050").value()->find(Quantity::AngularRate);
  EXPECT_NEAR(stated_density_si(mpu, "x").value(), 0.005 * degree / std::numbers::sqrt2, 1e-12);
  const SensorSheet& adis = *find_data_sheet("ADIS16405").value()->find(Quantity::AngularRate);
  EXPECT_NEAR(stated_density_si(adis, "x").value(), 2.0 * degree / 60.0, 1e-12);
  EXPECT_NEAR(stated_bias_stability_si(adis).value(), 0.007 * degree, 1e-9);
}

TEST(FindDataSheet, SaysWhatIsKnownAndWhatIsAmbiguous) {
  const auto unknown = find_data_sheet("HG1700");
  ASSERT_FALSE(unknown);
  EXPECT_EQ(unknown.error().code, ErrorCode::NotFound);
  EXPECT_NE(unknown.error().message.find("MPU-6050"), std::string::npos);
  EXPECT_NE(find_data_sheet("BMI160 BMI270").error().message.find("several"), std::string::npos);
}

TEST(FindDataSheet, NamesTheLongerOnesOfANameThatIsCutShort) {
  const auto family = find_data_sheet("Xsens MTi");
  ASSERT_FALSE(family);
  EXPECT_NE(family.error().message.find("begin so: MTi-28A53G35, MTi-28A33G35, MTi 1-series,"), std::string::npos)
      << family.error().message;
  EXPECT_EQ(family.error().message.find("MPU-6050"), std::string::npos) << family.error().message;
  EXPECT_NE(find_data_sheet("MTi-G").error().message.find("begin so: MTi-G-700, MTi-G-710."), std::string::npos);
  EXPECT_NE(find_data_sheet("Bosch").error().message.find("There is no data sheet"), std::string::npos);
}

}  // namespace
}  // namespace driftlab
